// IMU signals predicted by the estimated trajectory, next to the measured ones, for plots.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

// One entry for each sample of this sensor within both splines' range.
struct SensorSignal {
  std::vector<double> time_s;  // the IMU's own clock, since start_ns
  std::vector<Eigen::Vector3d> measured, predicted;
};

// In the IMU's own frame. Predictions include scale, misalignment, bias, lever arm, time offset and delay, so
// that measured - predicted is noise if the model is correct.
struct SignalPrediction {
  SensorSignal rate_rad_s, force_m_s2;
};

// `imu` is the index of `data` among state.imus. Throws Cancelled when asked to stop.
SignalPrediction predictSignals(const ImuData& data, std::int64_t start_ns, const CalibrationState& state,
                                std::size_t imu, const RunContext& context = {});

}  // namespace evical
