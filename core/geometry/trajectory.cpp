#include "core/geometry/trajectory.h"

namespace evical {

RigidTransform worldFromImu(const So3Spline& world_from_imu_rotation, const VectorSpline& imu_in_world_m,
                            double time_s) {
  const RotationSample rotation = evaluate(world_from_imu_rotation, time_s, RotationOrder::Rotation);
  return {Eigen::Quaterniond(rotation.rotation), evaluate(imu_in_world_m, time_s).value};
}

RigidTransform cameraFromWorld(const So3Spline& world_from_imu_rotation, const VectorSpline& imu_in_world_m,
                               const RigidTransform& reference_from_camera, double time_offset_s,
                               double camera_time_s) {
  return inverse(worldFromImu(world_from_imu_rotation, imu_in_world_m, camera_time_s + time_offset_s) *
                 reference_from_camera);
}

MotionSample motionAt(const So3Spline& world_from_imu_rotation, const VectorSpline& imu_in_world_m,
                      double time_s) {
  const RotationSample rotation = evaluate(world_from_imu_rotation, time_s);
  const VectorSample position = evaluate(imu_in_world_m, time_s);
  return {{Eigen::Quaterniond(rotation.rotation), position.value},
          position.velocity,
          position.acceleration,
          rotation.angular_velocity_rad_s,
          rotation.angular_acceleration_rad_s2};
}

}  // namespace evical
