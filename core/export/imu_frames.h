// IMU scales and misalignment in other programs' conventions. Ours: measured = M true + bias, M of the
// accelerometer upper triangular, which defines the IMU's frame. A program whose M is lower triangular means
// another frame, turned by `other_from_imu`, and all that refers to the IMU turns with it.
#pragma once

#include "core/data/calibration_state.h"

#include <Eigen/Core>

namespace evical {

struct TriangularTimesRotation {
  Eigen::Matrix3d triangular, rotation;
};

// matrix = lower (or upper) triangular, positive diagonal, times a rotation.
TriangularTimesRotation splitLower(const Eigen::Matrix3d& matrix);
TriangularTimesRotation splitUpper(const Eigen::Matrix3d& matrix);

// Zero residual: measured force = accelerometer * f + bias, measured rate = gyroscope * gyroscope_rotation *
// w + bias, f and w in the frame `other`; both matrices lower triangular.
struct LowerTriangularImu {
  Eigen::Matrix3d other_from_imu = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d accelerometer = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d gyroscope = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d gyroscope_rotation = Eigen::Matrix3d::Identity();
};
LowerTriangularImu lowerTriangular(const ImuState& imu);

bool hasMapping(const ImuState& imu);  // scales or misalignment other than none

// p_other = ... * p_imu, as a rigid transform without translation.
RigidTransform turnOf(const Eigen::Matrix3d& other_from_imu);

}  // namespace evical
