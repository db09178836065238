#include "core/report/shown_quantity.h"

#include "core/base/element.h"
#include "core/base/yaml_node.h"
#include "core/data/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

// "focal length x"
std::string inWords(std::string component) {
  std::ranges::replace_if(
      component, [](char c) { return c == '_' || c == '.'; }, ' ');
  return component;
}

template <class Rows, class State, class Uncertainty>
std::vector<ShownQuantity> shown(const Rows& rows, const std::string& sensor, const State& state,
                                 const Uncertainty& uncertainty, bool with_place) {
  std::vector<ShownQuantity> all;
  forEachQuantity(rows, [&](const auto& row) {
    if ((row.info.relative && !with_place) || !isPresent(row, state, uncertainty)) return;
    const Eigen::VectorXd values = quantityNumbers(row.value(state));
    const Eigen::VectorXd sigmas = quantityNumbers(row.sigma(uncertainty));
    ShownQuantity quantity{&row.info, {}};
    for (const QuantityPart& part : quantityParts(row.info, row.value(state))) {
      const auto k = static_cast<Eigen::Index>(quantity.numbers.size());
      const double sigma = k < sigmas.size() ? sigmas[k] : 0.0;
      quantity.numbers.push_back({sensor + "." + part.name, inWords(part.component), part.shown_unit,
                                  row.info.shown_factor * values[k], row.info.shown_factor * sigma});
    }
    all.push_back(std::move(quantity));
  });
  return all;
}

// Latency of the events of a sensor: the difference between its two time offsets.
constexpr QuantityInfo kLatency{.id = QuantityId::Latency,
                                .name = "latency",
                                .title = "latency",
                                .owner = QuantityOwner::Camera,
                                .shape = QuantityShape::Scalar,
                                .unit = "s",
                                .shown_unit = "ms",
                                .shown_factor = 1e3,
                                .decimals = 4,
                                .remark = "against frames"};

}  // namespace

std::vector<ShownQuantity> shownCamera(const NamedResult& named, std::size_t camera, bool with_place) {
  const std::string& name = named.cameras.at(camera).name;
  std::vector<ShownQuantity> all =
      shown(kCameraQuantities, name, named.result->state.cameras.at(camera),
            elementOrNone(named.result->uncertainty.cameras, camera), with_place);
  for (const SensorLatency& latency : named.result->latencies)
    if (latency.camera == camera)
      all.push_back({&kLatency,
                     {{name + "." + kLatency.name, "", kLatency.shown_unit,
                       kLatency.shown_factor * latency.latency_s, kLatency.shown_factor * latency.std_s}}});
  return all;
}

std::vector<ShownQuantity> shownImu(const NamedResult& named, std::size_t imu, bool with_place) {
  return shown(kImuQuantities, named.imus.at(imu).name, named.result->state.imus.at(imu),
               elementOrNone(named.result->uncertainty.imus, imu), with_place);
}

std::vector<ShownQuantity> shownBoard(const NamedResult& named, std::size_t board) {
  const CalibrationResult& result = *named.result;
  if (board > result.state.further_boards.size()) return {};
  return shown(kBoardQuantities, named.boards.at(board), result.state.boardAt(board),
               boardUncertainty(result.uncertainty, board), board > 0);
}

BoardUncertainty boardUncertainty(const UncertaintyReport& report, std::size_t board) {
  return board == 0 ? report.board : elementOrNone(report.further_boards, board - 1);
}

std::string boardTitle(const NamedResult& named, std::size_t board) {
  return named.boards.size() < 2 ? "Board" : "Board " + named.boards.at(board);
}

std::string unitAndRemark(const ShownQuantity& quantity) {
  const std::string remark = quantity.info->remark;
  return quantity.info->shown_unit + (remark.empty() ? "" : " " + remark);
}

bool isScale(const ShownNumber& number) {
  return number.part.size() == 2 && number.part[0] == number.part[1];
}

namespace {

std::string ownerName(const QuantityAddress& number, const NamedResult& named) {
  if (number.owner == QuantityOwner::Board) return named.boards.at(number.sensor);
  std::string name = kGravityQuantity.name;
  forEachSensorKind([&](auto kind) {
    if (number.owner == kind.kOwner) name = kind.of(named).at(number.sensor).name;
  });
  return name;
}

}  // namespace

std::string columnKeys(const QuantityAddress& number, const NamedResult& named) {
  constexpr std::array kOwners = {"camera", "imu", "board"};
  const auto owner = static_cast<std::size_t>(number.owner);
  const std::string component = quantityPart(number).component;
  std::string keys;
  if (owner < kOwners.size())
    keys = fmt::format("{}: {}, ", kOwners[owner], yamlText(ownerName(number, named)));
  keys += fmt::format("quantity: {}", quantityInfo(number.owner, number.id).name);
  return component.empty() ? keys : fmt::format("{}, component: {}", keys, component);
}

std::vector<std::string> columnNames(const NamedResult& named) {
  std::vector<std::string> names;
  for (const QuantityAddress& column : named.result->uncertainty.columns) {
    const QuantityPart part = quantityPart(column);
    names.push_back(fmt::format("{}.{} [{}]", ownerName(column, named), part.name, part.unit));
  }
  return names;
}

QuantityWords quantityWords(const QuantityAddress& number, const NamedResult& named) {
  const QuantityInfo& info = quantityInfo(number.owner, number.id);
  QuantityWords words{ownerName(number, named), info.title, quantityPart(number).component};
  if (info.shape == QuantityShape::UpperTriangle) words.quantity += " scale and misalignment";
  if (info.shape != QuantityShape::Intrinsics && info.shape != QuantityShape::Gravity) return words;
  const std::size_t dot = std::min(words.part.find('.'), words.part.size());
  words.quantity = words.part.substr(0, dot);
  words.part.erase(0, dot + 1);
  std::ranges::replace(words.quantity, '_', ' ');
  return words;
}

std::string quantitySentence(const QuantityWords& words) {
  std::string text = words.sensor.empty() ? words.quantity : words.sensor + ": " + words.quantity;
  return words.part.empty() ? text : text + " " + words.part;
}

std::vector<SensorPose> sensorPoses(const NamedResult& named) {
  using Kind = SensorPose::Kind;
  const CalibrationState& state = named.result->state;
  const bool by_camera =
      std::any_of(named.cameras.begin(), named.cameras.end(),
                  [&](const SensorDescription& camera) { return camera.name == named.reference; });
  const Kind reference_kind = by_camera ? Kind::Camera : Kind::Imu;
  std::vector<SensorPose> poses;
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    const CameraState& camera = state.cameras[i];
    if (named.cameras.at(i).name == named.reference) continue;
    poses.push_back({named.cameras[i].name, named.reference, Kind::Camera, reference_kind,
                     camera.reference_from_camera, camera.time_offset_s, i});
    if (by_camera && i > 0)
      poses.back().camera_from_camera_before =
          inverse(camera.reference_from_camera) * state.cameras[i - 1].reference_from_camera;
  }
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    if (named.imus.at(i).name == named.reference) continue;
    poses.push_back({named.imus[i].name, named.reference, Kind::Imu, reference_kind,
                     state.imus[i].reference_from_imu, state.imus[i].time_offset_s, i});
  }
  return poses;
}

std::string directionWords(const SensorPose& pose) {
  return fmt::format("transforms points of {0} to {1}: p_{1} = R p_{0} + t", pose.sensor, pose.reference);
}

std::string anglesWarning(const Eigen::Vector3d& roll_pitch_yaw_deg) {
  constexpr double kQuarterTurn_deg = 90.0, kNear_deg = 1.0;
  if (std::abs(std::abs(roll_pitch_yaw_deg.y()) - kQuarterTurn_deg) > kNear_deg) return {};
  return "angles are not unique here: use the quaternion";
}

}  // namespace evical
