// Motion of the reference IMU in the world (= board) frame, and of cameras attached to it.
#pragma once

#include "core/geometry/so3.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

namespace evical {

// Pose on the reference IMU's clock.
RigidTransform worldFromImu(const So3Spline& world_from_imu_rotation, const VectorSpline& imu_in_world_m,
                            double time_s);

// Pose of a camera at a time of the camera's clock; imu_time = camera_time + time_offset_s.
RigidTransform cameraFromWorld(const So3Spline& world_from_imu_rotation, const VectorSpline& imu_in_world_m,
                               const RigidTransform& reference_from_camera, double time_offset_s,
                               double camera_time_s);

// Motion state for plots and simulated measurements; angular rates in the body frame, the rest in the world.
struct MotionSample {
  RigidTransform world_from_imu;
  Eigen::Vector3d velocity_m_s, acceleration_m_s2;
  Eigen::Vector3d angular_velocity_rad_s, angular_acceleration_rad_s2;
};
MotionSample motionAt(const So3Spline& world_from_imu_rotation, const VectorSpline& imu_in_world_m,
                      double time_s);

}  // namespace evical
