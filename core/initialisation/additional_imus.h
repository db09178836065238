// Poses of further IMUs on the rig. Rotation and time offset as for a camera (docs/maths.md, 8.7): a
// gyroscope also measures its rotation between two instants. Then lever arm l and accelerometer bias b, which
// are linear for a known motion of the reference:
//   R f - R_wb^T (p'' - g) = ([a]x + [w]x [w]x) l + R b        with R = reference_from_imu.rotation.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialisation_options.h"

#include <cstdint>

namespace evical {

struct ImuRotation {
  RelativeRotation
      hand_eye;  // of the IMU instead of a camera; the bias is the further gyroscope's, in its own frame
  double correlation = 0.0;  // of the two gyroscopes' rates
};

// `reference` without its bias. Throws CalibrationFailed if they do not overlap or do not agree.
ImuRotation alignFurtherGyroscope(const ImuData& imu, std::int64_t start_ns, const GyroRotation& reference,
                                  const InitialisationOptions& options, const RunContext& context);

struct LeverArm {
  Eigen::Vector3d imu_in_reference_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
  double force_rms_m_s2 = 0.0;
  double std_m = 0.0;  // of the worst direction
};

// `state` must have trajectory and gravity.
LeverArm solveLeverArm(const ImuData& imu, std::int64_t start_ns, const ImuRotation& rotation,
                       const CalibrationState& state, const InitialisationOptions& options);

}  // namespace evical
