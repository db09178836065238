// Motion of a recording per axis (rotation and acceleration), which makes the calibration observable.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <cstdint>

namespace evical {

struct AssessedMotion {
  Eigen::Vector3d turn_rad_s = Eigen::Vector3d::Zero();         // RMS about the mean, per axis
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  // the same, without gravity if that is known
  bool along_camera = false;                                    // else along the IMU's axes
};

// `state`: initial state; the axes are then those of its first camera. Null: no state, axes of the IMU.
AssessedMotion assessMotion(const ImuData& reference_imu, std::int64_t start_ns,
                            const CalibrationState* state);

}  // namespace evical
