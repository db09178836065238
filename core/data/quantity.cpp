#include "core/data/quantity.h"

#include "core/data/intrinsics_result.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace evical {
namespace {

constexpr std::array kAxes = {"x", "y", "z"};
constexpr std::array kUpperTriangle = {"xx", "xy", "xz", "yy", "yz", "zz"};
constexpr std::array kPixelIntrinsics = {"focal_length.x", "focal_length.y", "principal_point.x",
                                         "principal_point.y"};

template <std::size_t Count>
std::vector<QuantityPart> namedParts(const QuantityInfo& info, const std::array<const char*, Count>& names) {
  std::vector<QuantityPart> parts;
  for (const char* name : names)
    parts.push_back({std::string(info.name) + "." + name, name, info.unit, info.shown_unit});
  return parts;
}

// Names of the pixel intrinsics and of the first `count` coefficients of a lens.
std::vector<QuantityPart> lensParts(const QuantityInfo& info, CameraModel model, std::size_t count) {
  std::vector<QuantityPart> parts;
  for (const char* name : kPixelIntrinsics) parts.push_back({name, name, info.unit, info.shown_unit});
  const auto coefficients = distortionNames(model);
  for (std::size_t k = 0; k < count; ++k) {
    const std::string name = std::string("distortion.") + coefficients.at(k);
    parts.push_back({name, name, "1", ""});
  }
  return parts;
}

}  // namespace

const QuantityInfo& quantityInfo(QuantityOwner owner, QuantityId id) {
  const QuantityInfo* found = kGravityQuantity.is(owner, id) ? &kGravityQuantity : nullptr;
  const auto look = [&](const auto& row) {
    if (row.info.is(owner, id)) found = &row.info;
  };
  forEachSensorKind([&](auto kind) { forEachQuantity(kind.rows(), look); });
  forEachQuantity(kBoardQuantities, look);
  if (found == nullptr) throw std::out_of_range("no such quantity");
  return *found;
}

std::vector<QuantityPart> quantityParts(const QuantityInfo& info) {
  switch (info.shape) {
    case QuantityShape::Scalar:
      return {{info.name, "", info.unit, info.shown_unit}};
    case QuantityShape::Vector3:
    case QuantityShape::Rotation:
    case QuantityShape::LocalRotation:
      return namedParts(info, kAxes);
    case QuantityShape::UpperTriangle:
      return namedParts(info, kUpperTriangle);
    case QuantityShape::Intrinsics:
      return {};
    case QuantityShape::Gravity:
      break;
  }
  return {{"direction.1", "direction.1", "rad", "deg"},
          {"direction.2", "direction.2", "rad", "deg"},
          {"norm", "norm", info.unit, info.shown_unit}};
}

std::vector<QuantityPart> quantityParts(const QuantityInfo& info,
                                        const std::optional<CameraIntrinsics>& value) {
  if (!value) return {};
  return lensParts(info, value->model, static_cast<std::size_t>(distortionCount(*value)));
}

QuantityPart quantityPart(const QuantityAddress& number) {
  const QuantityInfo& info = quantityInfo(number.owner, number.id);
  constexpr std::size_t kAll = std::tuple_size_v<decltype(CameraIntrinsics::distortion)>;
  return (number.model ? lensParts(info, *number.model, kAll) : quantityParts(info)).at(number.component);
}

std::vector<QuantityAddress> quantityAddresses(const CalibrationState& state) {
  std::vector<QuantityAddress> all;
  const auto add = [&](QuantityAddress number, std::size_t parts) {
    for (; number.component < parts; ++number.component) all.push_back(number);
  };
  const auto addRows = [&](const auto& rows, std::size_t k, const auto& sensor) {
    forEachQuantity(rows, [&](const auto& row) {
      const auto& value = row.value(sensor);
      add(quantityAddress(row.info, k, value), quantityParts(row.info, value).size());
    });
  };
  forEachSensorKind([&](auto kind) {
    for (std::size_t k = 0; k < kind.of(state).size(); ++k) addRows(kind.rows(), k, kind.of(state)[k]);
  });
  for (std::size_t k = 0; k <= state.further_boards.size(); ++k)
    addRows(kBoardQuantities, k, state.boardAt(k));
  add({}, quantityParts(kGravityQuantity).size());
  return all;
}

void setSigmas(UncertaintyReport& report) {
  for (const QuantityAddress& first : report.columns) {
    if (first.component != 0) continue;
    Eigen::VectorXd sigmas(0);
    QuantityAddress number = first;
    while (const auto column = columnOf(number, report.columns)) {
      sigmas.conservativeResize(sigmas.size() + 1);
      sigmas[sigmas.size() - 1] = report.standard_deviations[*column];
      ++number.component;
    }
    visitQuantity(first, std::tie(report),
                  [&](const auto& row, auto& sensor) { setQuantityNumbers(sigmas, row.sigma(sensor)); });
    if (first.id != QuantityId::Gravity) continue;
    report.gravity_direction_std_rad = sigmas.head<2>().norm() / std::sqrt(2.0);
    if (sigmas.size() == 3) report.gravity_norm_std_m_s2 = sigmas[2];
  }
}

Eigen::MatrixXd intrinsicsCovariance(const UncertaintyReport& report, std::size_t camera) {
  std::vector<Eigen::Index> columns;
  for (std::size_t k = 0; k < report.columns.size(); ++k)
    if (const QuantityAddress& each = report.columns[k];
        each.id == QuantityId::Intrinsics && each.sensor == camera)
      columns.push_back(static_cast<Eigen::Index>(k));
  return report.covariance()(columns, columns);
}

Eigen::VectorXd quantityNumbers(double value) {
  return Eigen::VectorXd::Constant(1, value);
}
Eigen::VectorXd quantityNumbers(const Eigen::Vector3d& value) {
  return value;
}
Eigen::VectorXd quantityNumbers(const Eigen::Quaterniond& value) {
  return quaternionLog(value);
}
Eigen::VectorXd quantityNumbers(const Eigen::Matrix3d& value) {
  Eigen::VectorXd numbers(6);
  numbers << value(0, 0), value(0, 1), value(0, 2), value(1, 1), value(1, 2), value(2, 2);
  return numbers;
}
Eigen::VectorXd quantityNumbers(const std::optional<CameraIntrinsics>& value) {
  if (!value) return {};
  Eigen::VectorXd numbers(9);
  writeIntrinsics(*value, numbers.data());
  return numbers;
}
Eigen::VectorXd quantityNumbers(const std::optional<std::array<double, 9>>& sigmas) {
  if (!sigmas) return {};
  return Eigen::Map<const Eigen::VectorXd>(sigmas->data(), static_cast<Eigen::Index>(sigmas->size()));
}

void setQuantityNumbers(const Eigen::VectorXd& numbers, double& value) {
  value = numbers[0];
}
void setQuantityNumbers(const Eigen::VectorXd& numbers, Eigen::Vector3d& value) {
  value = numbers;
}
void setQuantityNumbers(const Eigen::VectorXd& numbers, Eigen::Matrix3d& value) {
  value << numbers[0], numbers[1], numbers[2], 0.0, numbers[3], numbers[4], 0.0, 0.0, numbers[5];
}
void setQuantityNumbers(const Eigen::VectorXd& numbers, std::optional<std::array<double, 9>>& sigmas) {
  std::copy(numbers.begin(), numbers.end(), sigmas.emplace().begin());
}

Eigen::VectorXd quantityDifference(const QuantityInfo& info, const Eigen::Quaterniond& a,
                                   const Eigen::Quaterniond& b) {
  return quaternionLog(info.shape == QuantityShape::LocalRotation ? b.conjugate() * a : a * b.conjugate());
}

}  // namespace evical
