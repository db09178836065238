#include "core/report/signal_prediction.h"

#include "core/base/time.h"
#include "core/geometry/trajectory.h"

namespace evical {

SignalPrediction predictSignals(const ImuData& data, std::int64_t start_ns, const CalibrationState& state,
                                std::size_t imu, const RunContext& context) {
  constexpr std::size_t kSamplesBetweenStops = 1024;
  const ImuState& imu_state = state.imus[imu];
  const Eigen::Matrix3d imu_from_reference =
      imu_state.reference_from_imu.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d& lever_arm = imu_state.reference_from_imu.translation_m;
  SignalPrediction prediction;
  for (std::size_t k = 0; k < data.samples.size(); ++k) {
    if (k % kSamplesBetweenStops == 0) context.throwIfStopped();
    const ImuSample& sample = data.samples[k];
    const double imu_time_s = secondsSince(start_ns, sample.time_ns);
    const double time_s = referenceTime_s(imu_state, imu_time_s);
    if (!state.world_from_imu_rotation.contains(time_s) || !state.imu_in_world_m.contains(time_s)) continue;
    const MotionSample motion = motionAt(state.world_from_imu_rotation, state.imu_in_world_m, time_s);
    const Eigen::Vector3d& rate = motion.angular_velocity_rad_s;
    const Eigen::Vector3d force = motion.world_from_imu.rotation.conjugate() *
                                      (motion.acceleration_m_s2 - state.gravity_in_world_m_s2) +
                                  motion.angular_acceleration_rad_s2.cross(lever_arm) +
                                  rate.cross(rate.cross(lever_arm));
    prediction.time_s.push_back(imu_time_s);
    prediction.measured_rate_rad_s.push_back(sample.angular_rate_rad_s);
    prediction.predicted_rate_rad_s.push_back(imu_state.gyroscopeMatrix() * (imu_from_reference * rate) +
                                              imu_state.gyroscopeBiasAt_rad_s(imu_time_s));
    prediction.measured_force_m_s2.push_back(sample.specific_force_m_s2);
    prediction.predicted_force_m_s2.push_back(imu_state.accelerometer_mapping * (imu_from_reference * force) +
                                              imu_state.accelerometerBiasAt_m_s2(imu_time_s));
  }
  return prediction;
}

}  // namespace evical
