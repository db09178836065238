// Zero if an IMU's samples agree with its sensor model on the trajectory (docs/maths.md, 3.2):
//   gyroscope      r = [ M_g R_ga w_j + b_g - measured ] / sigma,   w_j = R^T w(t)
//   accelerometer  r = [ M_a f_j + b_a - measured ] / sigma,
//                  f_j = R^T [ R_wb(t)^T (p''(t) - g) + (a(t)^ + w(t)^ w(t)^) l ]
// with R, l = reference_from_imu and t = t_measured + time_offset + time_offset_drift (t_measured - t_0),
// less the delay for the accelerometer. For the reference IMU R = 1, l = 0, offset 0, and the last blocks are
// absent. One cost function holds all samples whose times fall into one spline segment.
//
// Blocks of the gyroscope: 4 rotation control points (x y z w), bias [rad/s], mapping, R_ga (gyroscope
// from accelerometer, x y z w); further IMUs: rotation (x y z w), time offset [s]. Blocks of the
// accelerometer: 4 rotation and 4 position control points [m], gravity in the world [m/s^2], bias [m/s^2],
// mapping, delay [s]; further IMUs: rotation, lever arm l [m], time offset. Drifting biases add two blocks at
// the end: the deviation of the bias from its mean at the knots before and after the samples; between
// them it is linear. Without unit. Mapping: the upper triangle row by row (m00 m01 m02 m11 m12
// m22). Quaternion blocks as in calibration_problem.h.
#pragma once

#include "core/geometry/spline_segment.h"

#include <ceres/cost_function.h>
#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <vector>

namespace evical {

struct InertialMeasurement {
  double time_s = 0.0;      // this IMU's clock, since the recording's start
  Eigen::Vector3d value;    // rad/s or m/s^2
  double by_drift_s = 0.0;  // change of the time per ppm of clock drift
};

enum class ImuRole { Reference, Further };

// Time between two knots of a bias, on the IMU's own clock.
struct DriftTimes {
  double start_s = 0.0, length_s = 0.0;

  double shareAt(double time_s) const { return std::clamp((time_s - start_s) / length_s, 0.0, 1.0); }
};

class GyroscopeCost final : public ceres::CostFunction {
 public:
  GyroscopeCost(ImuRole role, double sigma_rad_s, const SegmentTimes& segment,
                std::vector<InertialMeasurement> samples, std::optional<DriftTimes> drift = std::nullopt);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  ImuRole role_;
  double weight_;
  SegmentTimes segment_;
  std::vector<InertialMeasurement> samples_;
  std::optional<DriftTimes> drift_;
};

class AccelerometerCost final : public ceres::CostFunction {
 public:
  AccelerometerCost(ImuRole role, double sigma_m_s2, const SegmentTimes& segment,
                    std::vector<InertialMeasurement> samples, std::optional<DriftTimes> drift = std::nullopt);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  ImuRole role_;
  double weight_;
  SegmentTimes segment_;
  std::vector<InertialMeasurement> samples_;
  std::optional<DriftTimes> drift_;
};

// Upper triangle, row by row.
Eigen::Matrix3d mappingFromParameters(const double* parameters);
void parametersFromMapping(const Eigen::Matrix3d& mapping, double* parameters);
Eigen::Matrix<double, 3, 6> derivativeByMapping(const Eigen::Vector3d& v);  // of M v

}  // namespace evical
