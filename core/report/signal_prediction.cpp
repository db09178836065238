#include "core/report/signal_prediction.h"

#include "core/base/time.h"
#include "core/data/imu_prediction.h"

namespace evical {

SignalPrediction predictSignals(const ImuData& data, std::int64_t start_ns, const CalibrationState& state,
                                std::size_t imu, const RunContext& context) {
  constexpr std::size_t kSamplesBetweenStops = 1024;
  const ImuState& imu_state = state.imus[imu];
  SignalPrediction prediction;
  for (std::size_t k = 0; k < data.samples.size(); ++k) {
    if (k % kSamplesBetweenStops == 0) context.throwIfStopped();
    const ImuSample& sample = data.samples[k];
    const double stamp_s = secondsSince(start_ns, sample.time_ns);
    const auto rate = predictedRate_rad_s(state, imu_state, stamp_s);
    const auto force = predictedForce_m_s2(state, imu_state, stamp_s);
    if (!rate || !force) continue;
    prediction.time_s.push_back(stamp_s);
    prediction.measured_rate_rad_s.push_back(sample.angular_rate_rad_s);
    prediction.predicted_rate_rad_s.push_back(*rate);
    prediction.measured_force_m_s2.push_back(sample.specific_force_m_s2);
    prediction.predicted_force_m_s2.push_back(*force);
  }
  return prediction;
}

}  // namespace evical
