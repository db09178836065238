// All that the estimator estimates, initial or final. Frames: world = board; body = the reference IMU, or the
// reference camera where there is no IMU.
#pragma once

#include "core/geometry/camera_model.h"
#include "core/geometry/rigid_transform.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

struct CameraState {
  RigidTransform imu_from_camera;
  double time_offset_s = 0.0;  // imu_time = camera_time + time_offset_s
  double edge_lead_px = 0.0;   // measured centres lie this far ahead along their image motion, at 100 px/s
  double edge_lead_growth_px = 0.0;                 // for each factor e of speed
  std::optional<CameraIntrinsics> intrinsics = {};  // where they are solved for; else CameraData's hold
};

struct ImuState {
  RigidTransform reference_from_imu;  // identity for the reference
  double time_offset_s = 0.0;         // reference_time = imu_time + time_offset_s
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyroscope_mapping =
      Eigen::Matrix3d::Identity();  // upper triangular: measured = M true + bias
  Eigen::Matrix3d accelerometer_mapping = Eigen::Matrix3d::Identity();  // the same
};

// Times of the splines are seconds since the recording's start on the reference IMU's clock.
struct CalibrationState {
  So3Spline world_from_imu_rotation;
  VectorSpline imu_in_world_m;
  std::vector<CameraState> cameras;
  std::vector<ImuState> imus;
  Eigen::Vector3d gravity_in_world_m_s2 = Eigen::Vector3d(0.0, 0.0, -9.81);  // points down
};

}  // namespace evical
