#include "core/maintenance/gaussian_smoother.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evical {

void GaussianSmoother::add(double time_s, const Eigen::Vector3d& rate_rad_s,
                           const Eigen::Vector3d& force_m_s2) {
  if (!samples_.empty() && time_s <= samples_.back().time_s) return;
  samples_.push_back({time_s, rate_rad_s, force_m_s2});
}

void GaussianSmoother::forgetBefore(double time_s) {
  while (!samples_.empty() && samples_.front().time_s < time_s - 2.0 * reach_s()) samples_.pop_front();
}

std::optional<SmoothPoint> GaussianSmoother::at(double time_s) const {
  constexpr double kMissing = 0.02;  // share of the Gaussian that has no samples
  const auto earlier = [](const Sample& sample, double time) { return sample.time_s < time; };
  const auto first = std::lower_bound(samples_.begin(), samples_.end(), time_s - reach_s(), earlier);
  const auto last = std::lower_bound(samples_.begin(), samples_.end(), time_s + reach_s(), earlier);
  if (first == samples_.begin() || last == samples_.end() || last - first < 5) return std::nullopt;
  double sum = 0.0, moment = 0.0;
  SmoothPoint point;
  point.rate_rad_s = point.rate_slope_rad_s2 = point.force_m_s2 = point.force_slope_m_s3 =
      Eigen::Vector3d::Zero();
  point.rate_products = Eigen::Matrix3d::Zero();
  const double height = 1.0 / (sigma_s_ * std::sqrt(2.0 * std::numbers::pi));
  for (auto it = first; it != last; ++it) {
    const double u = (it->time_s - time_s) / sigma_s_;
    // Each stands for the time halfway to its neighbours.
    const double weight =
        height * std::exp(-0.5 * u * u) * 0.5 * (std::next(it)->time_s - std::prev(it)->time_s);
    const double slope = weight * u / sigma_s_;
    sum += weight;
    moment += slope;
    point.rate_rad_s += weight * it->rate_rad_s;
    point.force_m_s2 += weight * it->force_m_s2;
    point.rate_slope_rad_s2 += slope * it->rate_rad_s;
    point.force_slope_m_s3 += slope * it->force_m_s2;
    point.rate_products += weight * it->rate_rad_s * it->rate_rad_s.transpose();
    if (std::next(it)->time_s - it->time_s > 2.5 * sigma_s_) return std::nullopt;
  }
  if (std::abs(sum - 1.0) > kMissing) return std::nullopt;
  point.rate_rad_s /= sum;
  point.force_m_s2 /= sum;
  point.rate_products /= sum;
  point.rate_slope_rad_s2 -= moment * point.rate_rad_s;
  point.force_slope_m_s3 -= moment * point.force_m_s2;
  return point;
}

}  // namespace evical
