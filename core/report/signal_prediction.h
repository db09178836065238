// What the estimated trajectory says an IMU should have measured, beside what it did measure: for plots and
// for judging a fit by eye.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

// One entry a sample within both splines' range, in the IMU's own frame; scale, misalignment, bias, lever arm,
// time offset and delay are in the predictions, so that measured - predicted is noise if all is well.
struct SignalPrediction {
  std::vector<double> time_s;  // the IMU's own clock, since start_ns
  std::vector<Eigen::Vector3d> measured_rate_rad_s, predicted_rate_rad_s;
  std::vector<Eigen::Vector3d> measured_force_m_s2, predicted_force_m_s2;
};

// `imu` is the index of `data` among state.imus. Throws Cancelled when asked to stop.
SignalPrediction predictSignals(const ImuData& data, std::int64_t start_ns, const CalibrationState& state,
                                std::size_t imu, const RunContext& context = {});

}  // namespace evical
