// An IMU's samples under a Gaussian, at any time: linear and the same for all IMUs, so that what holds between their
// signals holds between the smoothed ones, however their samples lie. Of even samples a Gaussian of two intervals and
// more sums to the integral to better than 1e-15: nothing is interpolated.
#pragma once

#include <Eigen/Core>

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

  // In order of time; samples that are not are left out.
  void add(double time_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2);
  // Nothing where samples are missing.
  std::optional<SmoothPoint> at(double time_s) const;
  void forgetBefore(double time_s);  // times before it are not asked for any more

  bool empty() const { return samples_.empty(); }
  double latest_s() const { return samples_.back().time_s; }

 private:
  struct Sample {
    double time_s;
    Eigen::Vector3d rate_rad_s, force_m_s2;
  };
  double sigma_s_;
  std::deque<Sample> samples_;
};

}  // namespace evical
