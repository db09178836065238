#include "core/report/shown_quantity.h"

#include "core/base/element.h"

#include <algorithm>

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

}  // namespace evical
