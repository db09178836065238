// Predicted IMU measurement for a state, without noise: for residuals, plots and outliers.
#pragma once

#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

// In the IMU's own frame, with scale, misalignment and bias, for a sample with this stamp on the IMU's own
// clock. Empty outside the splines.
std::optional<Eigen::Vector3d> predictedRate_rad_s(const CalibrationState& state, const ImuState& imu,
                                                   double stamp_s);
std::optional<Eigen::Vector3d> predictedForce_m_s2(const CalibrationState& state, const ImuState& imu,
                                                   double stamp_s);

}  // namespace evical
