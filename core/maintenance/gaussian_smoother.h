// An IMU's samples under a Gaussian, at any time: linear and the same for all IMUs, so that what holds between their
// signals holds between the smoothed ones, however their samples lie. Of even samples a Gaussian of two intervals and
// more sums to the integral to better than 1e-15: nothing is interpolated.
#pragma once

#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <algorithm>
#include <deque>
#include <optional>

namespace evical {

struct SmoothPoint {
  Eigen::Vector3d rate_rad_s, rate_slope_rad_s2, force_m_s2, force_slope_m_s3;
  Eigen::Matrix3d rate_products;  // of the rates' components: what centripetal acceleration is made of
};

class GaussianSmoother {
 public:
  explicit GaussianSmoother(double sigma_s) : sigma_s_(sigma_s) {}

  double reach_s() const { return 5.0 * sigma_s_; }

  // In order of time; samples that are not are left out. Each sensor is smoothed over its own samples.
  void add(double time_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2,
           MeasuredBy measured_by = MeasuredBy::Both);
  // Nothing where samples are missing.
  std::optional<SmoothPoint> at(double time_s) const;
  void forgetBefore(double time_s);  // times before it are not asked for any more

  bool empty() const { return rates_.empty() || forces_.empty(); }
  double latest_s() const { return std::min(rates_.back().time_s, forces_.back().time_s); }

 private:
  struct Sample {
    double time_s;
    Eigen::Vector3d value;
  };
  // Sums over one sensor's samples: its mean, its slope, and of the products of components.
  struct Smoothed {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  };
  std::optional<Smoothed> at(double time_s, const std::deque<Sample>& samples) const;

  double sigma_s_;
  std::deque<Sample> rates_, forces_;
};

}  // namespace evical
