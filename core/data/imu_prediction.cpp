#include "core/data/imu_prediction.h"

namespace evical {

std::optional<Eigen::Vector3d> predictedRate_rad_s(const CalibrationState& state, const ImuState& imu,
                                                   double stamp_s) {
  const double time_s = referenceTime_s(imu, stamp_s);
  if (!state.world_from_imu_rotation.contains(time_s)) return std::nullopt;
  const Eigen::Vector3d rate =
      evaluate(state.world_from_imu_rotation, time_s, RotationOrder::Velocity).angular_velocity_rad_s;
  return imu.gyroscopeMatrix() * (imu.reference_from_imu.rotation.conjugate() * rate) +
         imu.gyroscopeBiasAt_rad_s(stamp_s);
}

std::optional<Eigen::Vector3d> predictedForce_m_s2(const CalibrationState& state, const ImuState& imu,
                                                   double stamp_s) {
  const double time_s = accelerometerTime_s(imu, stamp_s);
  if (!state.world_from_imu_rotation.contains(time_s) || !state.imu_in_world_m.contains(time_s))
    return std::nullopt;
  const RotationSample rotation = evaluate(state.world_from_imu_rotation, time_s);
  const Eigen::Vector3d acceleration = evaluate(state.imu_in_world_m, time_s).acceleration;
  const Eigen::Vector3d& w = rotation.angular_velocity_rad_s;
  const Eigen::Vector3d& lever_arm = imu.reference_from_imu.translation_m;
  const Eigen::Vector3d force = rotation.rotation.transpose() * (acceleration - state.gravity_in_world_m_s2) +
                                rotation.angular_acceleration_rad_s2.cross(lever_arm) +
                                w.cross(w.cross(lever_arm));
  return imu.accelerometer_scale_misalignment * (imu.reference_from_imu.rotation.conjugate() * force) +
         imu.accelerometerBiasAt_m_s2(stamp_s);
}

}  // namespace evical
