// Addresses of a rig's numbers: they identify the columns of a covariance.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

enum class QuantityOwner { Camera, Imu, Board, Rig };

// Unique within an owner.
enum class QuantityId {
  Rotation,
  Translation,
  TimeOffset,
  TimeOffsetDrift,
  LineDelay,
  ExposureShare,
  EdgeLocalisationBias,
  SlowEdgeLocalisationBias,
  Intrinsics,
  GyroscopeBias,
  AccelerometerBias,
  GyroscopeScaleMisalignment,
  AccelerometerScaleMisalignment,
  AccelerometerDelay,
  GyroscopeRotation,
  Scale,
  Stretch,
  RowCurvature,
  ColumnCurvature,
  Twist,
  Gravity,
  Latency  // follows from two time offsets: not in covariances
};

struct QuantityAddress {
  QuantityOwner owner = QuantityOwner::Rig;
  std::size_t sensor = 0;  // index among those of its kind; board 0 is the world's
  QuantityId id = QuantityId::Gravity;
  std::size_t component = 0;              // in the order of quantityParts
  std::optional<CameraModel> model = {};  // of intrinsics: numbers of different models are not comparable

  bool operator==(const QuantityAddress&) const = default;
};

// Empty if the number is not estimated.
inline std::optional<Eigen::Index> columnOf(const QuantityAddress& number,
                                            const std::vector<QuantityAddress>& columns) {
  const auto found = std::find(columns.begin(), columns.end(), number);
  return found == columns.end() ? std::nullopt : std::optional(found - columns.begin());
}

}  // namespace evical
