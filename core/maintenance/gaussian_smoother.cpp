#include "core/maintenance/gaussian_smoother.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evical {

void GaussianSmoother::add(double time_s, const Eigen::Vector3d& rate_rad_s,
                           const Eigen::Vector3d& force_m_s2, MeasuredBy measured_by) {
  const auto take = [time_s](std::deque<Sample>& samples, const Eigen::Vector3d& value) {
    if (samples.empty() || time_s > samples.back().time_s) samples.push_back({time_s, value});
  };
  if (measured_by != MeasuredBy::Accelerometer) take(rates_, rate_rad_s);
  if (measured_by != MeasuredBy::Gyroscope) take(forces_, force_m_s2);
}

void GaussianSmoother::forgetBefore(double time_s) {
  for (std::deque<Sample>* samples : {&rates_, &forces_})
    while (!samples->empty() && samples->front().time_s < time_s - 2.0 * reach_s()) samples->pop_front();
}

std::optional<GaussianSmoother::Smoothed> GaussianSmoother::at(double time_s,
                                                               const std::deque<Sample>& samples) const {
  constexpr double kMissing = 0.02;  // share of the Gaussian without samples
  const auto earlier = [](const Sample& sample, double time) { return sample.time_s < time; };
  const auto first = std::lower_bound(samples.begin(), samples.end(), time_s - reach_s(), earlier);
  const auto last = std::lower_bound(samples.begin(), samples.end(), time_s + reach_s(), earlier);
  if (first == samples.begin() || last == samples.end() || last - first < 5) return std::nullopt;
  double sum = 0.0, moment = 0.0;
  Smoothed found;
  const double height = 1.0 / (sigma_s_ * std::sqrt(2.0 * std::numbers::pi));
  for (auto it = first; it != last; ++it) {
    const double u = (it->time_s - time_s) / sigma_s_;
    // Each sample represents the time halfway to its neighbours.
    const double weight =
        height * std::exp(-0.5 * u * u) * 0.5 * (std::next(it)->time_s - std::prev(it)->time_s);
    const double slope = weight * u / sigma_s_;
    sum += weight;
    moment += slope;
    found.mean += weight * it->value;
    found.slope += slope * it->value;
    found.products += weight * it->value * it->value.transpose();
    if (std::next(it)->time_s - it->time_s > 2.5 * sigma_s_) return std::nullopt;
  }
  if (std::abs(sum - 1.0) > kMissing) return std::nullopt;
  found.mean /= sum;
  found.products /= sum;
  found.slope -= moment * found.mean;
  return found;
}

std::optional<SmoothPoint> GaussianSmoother::at(double time_s) const {
  const std::optional<Smoothed> rate = at(time_s, rates_);
  const std::optional<Smoothed> force = rate ? at(time_s, forces_) : std::nullopt;
  if (!force) return std::nullopt;
  return SmoothPoint{rate->mean, rate->slope, force->mean, force->slope, rate->products};
}

}  // namespace evical
