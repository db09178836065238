// All estimated quantities, initial or final. Frames: world = board (the first of several); body = the
// reference IMU, or the reference camera if there is no IMU.
#pragma once

#include "core/data/camera_lens.h"
#include "core/geometry/so3.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace evical {

// Drift of an IMU's biases about their means: straight lines between equidistant knots, on the IMU's own
// clock (seconds since the recording's start). Constant before the first and after the last knot.
struct BiasDrift {
  double start_s = 0.0, knot_spacing_s = 0.0;
  std::vector<Eigen::Vector3d> gyroscope_rad_s, accelerometer_m_s2;  // at the knots, minus the means

  std::size_t knots() const { return gyroscope_rad_s.size(); }  // 0: constant biases
  double knotTime_s(std::size_t knot) const { return start_s + static_cast<double>(knot) * knot_spacing_s; }

  // Index of the last knot before a time, except the final knot.
  std::size_t segmentAt(double time_s) const {
    const double place = std::floor((time_s - start_s) / knot_spacing_s);
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(knots()) - 2.0));
  }
  // Relative position of a time between knot `segment` and the next, 0 to 1.
  double shareAt(std::size_t segment, double time_s) const {
    return std::clamp((time_s - knotTime_s(segment)) / knot_spacing_s, 0.0, 1.0);
  }
  Eigen::Vector3d of(const std::vector<Eigen::Vector3d>& at_knots, double time_s) const {
    if (knots() < 2) return Eigen::Vector3d::Zero();
    const std::size_t segment = segmentAt(time_s);
    const double share = shareAt(segment, time_s);
    return (1.0 - share) * at_knots[segment] + share * at_knots[segment + 1];
  }
  // A knot's weight in the mean over the time between the first and the last knot.
  double weight(std::size_t knot) const {
    const double inner = 1.0 / (static_cast<double>(knots()) - 1.0);
    return knot == 0 || knot + 1 == knots() ? 0.5 * inner : inner;
  }
};

struct CameraState {
  RigidTransform reference_from_camera;
  double time_offset_s = 0.0;  // see referenceTime_s
  double edge_localisation_bias_px =
      0.0;  // distance of measured centres ahead of their place, along their image motion
  double slow_edge_localisation_bias_px = 0.0;  // additional bias near standstill
  CameraLens lens = {};                         // `solved` if its intrinsics are estimated
  double time_offset_drift_ppm = 0.0;           // if it is estimated
  double time_offset_at_s = 0.0;                // the camera's time at which the offset is time_offset_s
  double line_delay_us = 0.0;                   // of frames: from one row's exposure to the next one's
  double exposure_share = 0.0;  // of frames: share of a longer exposure between the stamp and the middle
};

struct ImuState {
  RigidTransform reference_from_imu;                               // identity for the reference
  double time_offset_s = 0.0;                                      // see referenceTime_s
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();  // if they drift: the means over time
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyroscope_scale_misalignment =
      Eigen::Matrix3d::Identity();  // upper triangular: measured = M true + bias
  Eigen::Matrix3d accelerometer_scale_misalignment = Eigen::Matrix3d::Identity();  // the same
  // The IMU's frame is the accelerometer's; the gyroscope may be misaligned with it.
  Eigen::Quaterniond gyroscope_from_accelerometer = Eigen::Quaterniond::Identity();
  // The IMU's clock is the gyroscope's: the accelerometer's sample stamped t was measured at t minus this.
  double accelerometer_delay_s = 0.0;

  BiasDrift bias_drift;                                        // without knots: biases are constant
  double time_offset_drift_ppm = 0.0, time_offset_at_s = 0.0;  // as a camera's

  // `t` is on the IMU's own clock.
  Eigen::Vector3d gyroscopeBiasAt_rad_s(double time_s) const {
    return gyroscope_bias_rad_s + bias_drift.of(bias_drift.gyroscope_rad_s, time_s);
  }
  Eigen::Vector3d accelerometerBiasAt_m_s2(double time_s) const {
    return accelerometer_bias_m_s2 + bias_drift.of(bias_drift.accelerometer_m_s2, time_s);
  }
  // measured rate = (this matrix) * (rate in the IMU's frame) + bias.
  Eigen::Matrix3d gyroscopeMatrix() const {
    return gyroscope_scale_misalignment * gyroscope_from_accelerometer.toRotationMatrix();
  }
};

// The clock of a camera or an IMU has a constant drift relative to the reference:
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

// Reference time at which the accelerometer measured a sample with this stamp; for the gyroscope:
// referenceTime_s.
inline double accelerometerTime_s(const ImuState& imu, double imu_time_s) {
  return referenceTime_s(imu, imu_time_s) - imu.accelerometer_delay_s;
}

// The true board relative to the specified one (board.h): its point (x, y) is at
// scale ((1 + stretch / 2) x, (1 - stretch / 2) y), and behind the plane that touches it at its origin by
// (row_curvature x^2 + column_curvature y^2) / 2 + twist x y: a sheet that is bent about any one axis.
struct BoardState {
  double scale = 1.0, stretch = 0.0;
  double row_curvature_1_m = 0.0, column_curvature_1_m = 0.0, twist_1_m = 0.0;
  RigidTransform world_from_board = {};  // identity for the board whose frame is the world

  // Position of a board point in the board's own frame, and in the world's.
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

  // Index 0 is the world's board.
  BoardState& boardAt(std::size_t index) { return index == 0 ? board : further_boards.at(index - 1); }
  const BoardState& boardAt(std::size_t index) const {
    return index == 0 ? board : further_boards.at(index - 1);
  }
};

}  // namespace evical
