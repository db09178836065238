// The rotation spline in the world: the gyroscope's rotation, corrected by the cameras' poses
// (docs/maths.md, 8.4).
#pragma once

#include "core/geometry/so3_spline.h"
#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/camera_poses.h"

#include <span>
#include <vector>

namespace evical {

struct AlignedCamera {
  std::vector<CameraPose> poses;
  RelativeRotation hand_eye;
  std::size_t camera = 0;  // index into the input's
};

// Knot spacing of the cameras' correction of the gyroscope: for its slow drift, or for the error of a
// saturated one.
inline constexpr double kDriftKnot_s = 1.0, kSaturatedDriftKnot_s = 0.1;

// world_from_imu on the IMU's clock over [begin_s, end_s]; `gyro` without its bias.
So3Spline fitWorldRotation(std::span<const AlignedCamera> cameras, const GyroRotation& gyro, double begin_s,
                           double end_s, double knot_spacing_s, double drift_knot_s = kDriftKnot_s);

}  // namespace evical
