#include "core/data/quantity.h"

#include "core/data/intrinsics_result.h"
#include "core/geometry/intrinsics_numbers.h"
#include "core/geometry/so3.h"

#include <algorithm>

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
    parts.push_back({std::string(info.name) + "." + name, info.unit, info.shown_unit});
  return parts;
}

}  // namespace

std::vector<QuantityPart> quantityParts(const QuantityInfo& info) {
  switch (info.shape) {
    case QuantityShape::Scalar:
      return {{info.name, info.unit, info.shown_unit}};
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
  return {{"direction.1", "rad", "deg"}, {"direction.2", "rad", "deg"}, {"norm", info.unit, info.shown_unit}};
}

std::vector<QuantityPart> quantityParts(const QuantityInfo& info,
                                        const std::optional<CameraIntrinsics>& value) {
  std::vector<QuantityPart> parts;
  if (!value) return parts;
  for (const char* name : kPixelIntrinsics) parts.push_back({name, info.unit, info.shown_unit});
  const auto coefficients = distortionNames(value->model);
  for (std::size_t k = 0; k < static_cast<std::size_t>(distortionCount(*value)); ++k)
    parts.push_back({std::string("distortion.") + coefficients[k], "1", ""});
  return parts;
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
