#include "core/optimisation/sample_errors.h"

#include "core/base/time.h"
#include "core/geometry/trajectory.h"

#include <cmath>

namespace evical {

SampleErrors sampleErrors(const CalibrationInput& input, const CalibrationState& state, std::size_t imu) {
  const ImuState& imu_state = state.imus[imu];
  const Eigen::Matrix3d imu_from_reference =
      imu_state.reference_from_imu.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d& lever_arm = imu_state.reference_from_imu.translation_m;
  SampleErrors errors;
  double gyroscope2 = 0.0, accelerometer2 = 0.0;
  for (const ImuSample& sample : input.imus[imu].samples) {
    const double imu_time_s = secondsSince(input.start_ns, sample.time_ns);
    const double time_s = referenceTime_s(imu_state, imu_time_s);
    if (!state.world_from_imu_rotation.contains(time_s)) continue;
    const RotationSample rotation = evaluate(state.world_from_imu_rotation, time_s);
    const Eigen::Vector3d& w = rotation.angular_velocity_rad_s;
    gyroscope2 += (imu_state.gyroscopeMatrix() * (imu_from_reference * w) +
                   imu_state.gyroscopeBiasAt_rad_s(imu_time_s) - sample.angular_rate_rad_s)
                      .squaredNorm();
    ++errors.gyroscope_samples;
    if (!state.imu_in_world_m.contains(time_s)) continue;
    const Eigen::Vector3d acceleration = evaluate(state.imu_in_world_m, time_s).acceleration;
    const Eigen::Vector3d force =
        rotation.rotation.transpose() * (acceleration - state.gravity_in_world_m_s2) +
        rotation.angular_acceleration_rad_s2.cross(lever_arm) + w.cross(w.cross(lever_arm));
    accelerometer2 += (imu_state.accelerometer_mapping * (imu_from_reference * force) +
                       imu_state.accelerometerBiasAt_m_s2(imu_time_s) - sample.specific_force_m_s2)
                          .squaredNorm();
    ++errors.accelerometer_samples;
  }
  const auto rms = [](double sum, int samples) {
    return samples > 0 ? std::sqrt(sum / (3.0 * samples)) : 0.0;
  };
  errors.gyroscope_rms_rad_s = rms(gyroscope2, errors.gyroscope_samples);
  errors.accelerometer_rms_m_s2 = rms(accelerometer2, errors.accelerometer_samples);
  return errors;
}

}  // namespace evical
