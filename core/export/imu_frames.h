// IMU scales and misalignment in other programs' conventions. Evical: measured = M true + bias, M of the
// accelerometer upper triangular, which defines the IMU's frame. A lower triangular M in another program
// defines another frame, rotated by `other_from_imu`, and everything in the IMU's frame rotates with it.
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

bool hasMapping(const ImuState& imu);  // true unless both matrices are the identity

// p_other = ... * p_imu, as a rigid transform without translation.
RigidTransform turnOf(const Eigen::Matrix3d& other_from_imu);

}  // namespace evical
