// All that the estimator estimates, initial or final. Frames: world = board (the first of several); body = the reference IMU, or the
// reference camera where there is no IMU.
#pragma once

#include "core/data/bias_drift.h"
#include "core/data/camera_lens.h"
#include "core/geometry/rigid_transform.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace evical {

struct CameraState {
  RigidTransform reference_from_camera;
  double time_offset_s = 0.0;          // see referenceTime_s
  double edge_lead_px = 0.0;           // measured centres lie this far ahead along their image motion
  double slow_edge_lead_px = 0.0;      // this much further, near standstill
  CameraLens lens = {};                // `solved` where its intrinsics are estimated
  double time_offset_drift_ppm = 0.0;  // where it is solved for
  double time_offset_at_s = 0.0;       // the camera's time at which the offset is time_offset_s
  double line_delay_us = 0.0;          // of frames: from one row's exposure to the next one's
  double exposure_share =
      0.0;  // of frames: how much of a longer exposure passes from the stamp to the middle
};

struct ImuState {
  RigidTransform reference_from_imu;                               // identity for the reference
  double time_offset_s = 0.0;                                      // see referenceTime_s
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();  // where they drift: the means over time
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyroscope_mapping =
      Eigen::Matrix3d::Identity();  // upper triangular: measured = M true + bias
  Eigen::Matrix3d accelerometer_mapping = Eigen::Matrix3d::Identity();  // the same
  // The IMU's frame is the accelerometer's; the gyroscope may be turned against it.
  Eigen::Quaterniond gyroscope_from_accelerometer = Eigen::Quaterniond::Identity();
  // The IMU's clock is the gyroscope's: the accelerometer's sample stamped t is of t less this.
  double accelerometer_delay_s = 0.0;

  BiasDrift bias_drift;                                        // without knots: biases are constant
  double time_offset_drift_ppm = 0.0, time_offset_at_s = 0.0;  // as a camera's

  // At a time on the IMU's own clock.
  Eigen::Vector3d gyroscopeBiasAt_rad_s(double time_s) const {
    return gyroscope_bias_rad_s + bias_drift.of(bias_drift.gyroscope_rad_s, time_s);
  }
  Eigen::Vector3d accelerometerBiasAt_m_s2(double time_s) const {
    return accelerometer_bias_m_s2 + bias_drift.of(bias_drift.accelerometer_m_s2, time_s);
  }
  // measured rate = this times the rate in the IMU's frame + bias.
  Eigen::Matrix3d gyroscopeMatrix() const {
    return gyroscope_mapping * gyroscope_from_accelerometer.toRotationMatrix();
  }
};

// A camera's or an IMU's clock runs evenly, but not quite at the reference's pace:
//   reference_time = sensor_time + time_offset_s + 1e-6 time_offset_drift_ppm (sensor_time -
//   time_offset_at_s).
template <class Sensor>
double timeOffsetAt_s(const Sensor& sensor, double sensor_time_s) {
  return sensor.time_offset_s +
         1e-6 * sensor.time_offset_drift_ppm * (sensor_time_s - sensor.time_offset_at_s);
}
template <class Sensor>
double referenceTime_s(const Sensor& sensor, double sensor_time_s) {
  return sensor_time_s + timeOffsetAt_s(sensor, sensor_time_s);
}
template <class Sensor>
double sensorTime_s(const Sensor& sensor, double reference_time_s) {
  const double pace = 1e-6 * sensor.time_offset_drift_ppm;
  return (reference_time_s - sensor.time_offset_s + pace * sensor.time_offset_at_s) / (1.0 + pace);
}

// When the accelerometer measured what is stamped so; the gyroscope at referenceTime_s.
inline double accelerometerTime_s(const ImuState& imu, double imu_time_s) {
  return referenceTime_s(imu, imu_time_s) - imu.accelerometer_delay_s;
}

// The board as it is, against what is said of it (board.h): a point (x, y) of it lies at
// scale ((1 + stretch / 2) x, (1 - stretch / 2) y), and behind the plane that touches it at its origin by
// (row_curvature x^2 + column_curvature y^2) / 2 + twist x y: a sheet that is bent about any one axis.
struct BoardState {
  double scale = 1.0, stretch = 0.0;
  double row_curvature_1_m = 0.0, column_curvature_1_m = 0.0, twist_1_m = 0.0;
  RigidTransform world_from_board = {};  // identity for the one whose frame is the world

  // In the board's own frame, and in the world's.
  Eigen::Vector3d onSheet_m(const Eigen::Vector2d& on_board_m) const {
    const double x = on_board_m.x(), y = on_board_m.y();
    return {scale * (1.0 + 0.5 * stretch) * x, scale * (1.0 - 0.5 * stretch) * y,
            0.5 * (row_curvature_1_m * x * x + column_curvature_1_m * y * y) + twist_1_m * x * y};
  }
  Eigen::Vector3d place_m(const Eigen::Vector2d& on_board_m) const {
    return world_from_board * onSheet_m(on_board_m);
  }
  Eigen::Vector3d normal() const { return world_from_board.rotation * Eigen::Vector3d::UnitZ(); }
};

// Times of the splines are seconds since the recording's start on the reference IMU's clock.
struct CalibrationState {
  So3Spline world_from_imu_rotation;
  VectorSpline imu_in_world_m;
  std::vector<CameraState> cameras;
  std::vector<ImuState> imus;
  BoardState board = {};
  std::vector<BoardState> further_boards = {};
  Eigen::Vector3d gravity_in_world_m_s2 = Eigen::Vector3d(0.0, 0.0, -9.81);  // points down

  // 0: the world's.
  BoardState& boardAt(std::size_t index) { return index == 0 ? board : further_boards.at(index - 1); }
  const BoardState& boardAt(std::size_t index) const {
    return index == 0 ? board : further_boards.at(index - 1);
  }
};

}  // namespace evical
