// Which of a rig's numbers one is: what the columns of a covariance are addressed by.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

enum class QuantityOwner { Camera, Imu, Board, Rig };

// An owner has each of them once.
enum class QuantityId {
  Rotation,
  Translation,
  TimeOffset,
  TimeOffsetDrift,
  LineDelay,
  ExposureShare,
  EdgeLead,
  SlowEdgeLead,
  Intrinsics,
  GyroscopeBias,
  AccelerometerBias,
  GyroscopeMapping,
  AccelerometerMapping,
  AccelerometerDelay,
  GyroscopeRotation,
  Scale,
  Stretch,
  RowCurvature,
  ColumnCurvature,
  Twist,
  Gravity,
  Latency  // follows from two time offsets: no covariance has it
};

struct QuantityAddress {
  QuantityOwner owner = QuantityOwner::Rig;
  std::size_t sensor = 0;  // among those of its kind; of boards 0 is the world's
  QuantityId id = QuantityId::Gravity;
  std::size_t component = 0;              // as quantityParts lists them
  std::optional<CameraModel> model = {};  // of intrinsics: those of another model mean something else

  bool operator==(const QuantityAddress&) const = default;
};

// Nothing where the number is not estimated.
inline std::optional<Eigen::Index> columnOf(const QuantityAddress& number,
                                            const std::vector<QuantityAddress>& columns) {
  const auto found = std::find(columns.begin(), columns.end(), number);
  return found == columns.end() ? std::nullopt : std::optional(found - columns.begin());
}

}  // namespace evical
