// Gaussian smoothing of an IMU's samples, at any time: linear and the same for all IMUs, so that relations
// between their signals are also valid for the smoothed ones, for any sampling. For equidistant samples and a
// sigma of at least two intervals, the sum equals the integral to better than 1e-15: nothing is interpolated.
#pragma once

#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <algorithm>
#include <deque>
#include <optional>

namespace evical {

struct SmoothPoint {
  Eigen::Vector3d rate_rad_s, rate_slope_rad_s2, force_m_s2, force_slope_m_s3;
  Eigen::Matrix3d rate_products;  // of the rates' components, for centripetal accelerations
};

class GaussianSmoother {
 public:
  explicit GaussianSmoother(double sigma_s) : sigma_s_(sigma_s) {}

  double reach_s() const { return 5.0 * sigma_s_; }

  // In order of time; samples out of order are dropped. Each sensor is smoothed over its own samples.
  void add(double time_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2,
           MeasuredBy measured_by = MeasuredBy::Both);
  // Empty if samples are missing.
  std::optional<SmoothPoint> at(double time_s) const;
  void forgetBefore(double time_s);  // earlier times will not be requested any more

  bool empty() const { return rates_.empty() || forces_.empty(); }
  double latest_s() const { return std::min(rates_.back().time_s, forces_.back().time_s); }

 private:
  struct Sample {
    double time_s;
    Eigen::Vector3d value;
  };
  // Smoothed values of one sensor: mean, slope, and products of components.
  struct Smoothed {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  };
  std::optional<Smoothed> at(double time_s, const std::deque<Sample>& samples) const;

  double sigma_s_;
  std::deque<Sample> rates_, forces_;
};

}  // namespace evical
