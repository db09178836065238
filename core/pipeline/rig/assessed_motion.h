// How a recording was moved, along and about each axis: what makes rotation, translation and time offset visible.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <cstdint>

namespace evical {

struct AssessedMotion {
  Eigen::Vector3d turn_rad_s = Eigen::Vector3d::Zero();  // RMS about the mean, per axis
  Eigen::Vector3d acceleration_m_s2 =
      Eigen::Vector3d::Zero();  // the same, without gravity where that is known
  bool along_camera = false;    // else along the IMU's axes
};

// `state`: a first one, whose first camera's axes these are then. Null: there is none.
AssessedMotion assessMotion(const ImuData& reference_imu, std::int64_t start_ns,
                            const CalibrationState* state);

}  // namespace evical
