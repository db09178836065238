// Translation, gravity, accelerometer bias and the position spline, all linear once the rotation is known
// (method 5.5 and 5.6 in one): with control points P, lever t = imu_from_camera.translation, gravity g and
// bias b,
//   p(t_k) = p_wc(t_k) - R_wb(t_k) t          at every view,
//   p''(t) = R_wb(t) (f - b) + g              at every (averaged) accelerometer sample.
#pragma once

#include "core/data/imu_sample.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/initialisation_options.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace evical {

struct GravityAlignment {
  VectorSpline imu_in_world_m;
  Eigen::Vector3d camera_in_imu_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_in_world_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
  double position_rms_m = 0.0, acceleration_rms_m_s2 = 0.0;
  double camera_in_imu_std_m = 0.0;  // largest, at the sigmas of the options
};

// `rotation` (world_from_imu, IMU clock) gives range and knots. Poses are at camera time; imu time = that +
// offset.
GravityAlignment alignGravity(const std::vector<CameraPose>& poses, double time_offset_s,
                              std::span<const ImuSample> samples, std::int64_t start_ns,
                              const So3Spline& rotation, const InitialisationOptions& options);

}  // namespace evical
