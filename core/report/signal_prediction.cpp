#include "core/report/signal_prediction.h"

#include "core/base/time.h"
#include "core/data/imu_prediction.h"

namespace evical {
namespace {

void add(double time_s, const Eigen::Vector3d& measured, const Eigen::Vector3d& predicted,
         SensorSignal& signal) {
  signal.time_s.push_back(time_s);
  signal.measured.push_back(measured);
  signal.predicted.push_back(predicted);
}

}  // namespace

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
    if (measuresRate(sample)) add(stamp_s, sample.angular_rate_rad_s, *rate, prediction.rate_rad_s);
    if (measuresForce(sample)) add(stamp_s, sample.specific_force_m_s2, *force, prediction.force_m_s2);
  }
  return prediction;
}

}  // namespace evical
