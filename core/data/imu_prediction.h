// What a state says that an IMU measures, without noise: for residuals, plots and outliers.
#pragma once

#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

// In the IMU's own frame, scale, misalignment and bias included, of a sample stamped so on the IMU's own clock.
// Nothing outside the splines.
std::optional<Eigen::Vector3d> predictedRate_rad_s(const CalibrationState& state, const ImuState& imu,
                                                   double stamp_s);
std::optional<Eigen::Vector3d> predictedForce_m_s2(const CalibrationState& state, const ImuState& imu,
                                                   double stamp_s);

}  // namespace evical
