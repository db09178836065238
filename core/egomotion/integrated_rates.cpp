#include "core/egomotion/integrated_rates.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <algorithm>

namespace evical {

SummedRates::SummedRates(std::span<const ImuSample> samples, std::int64_t start_ns) {
  std::vector<double> steps_s;
  for (const ImuSample& sample : samples) {
    const double time_s = secondsSince(start_ns, sample.time_ns);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (!times_s_.empty()) {
      const double step_s = time_s - times_s_.back();
      if (!(step_s > 0.0)) continue;
      steps_s.push_back(step_s);
      sum = sums_rad_.back() + 0.5 * step_s * (rates_rad_s_.back() + sample.angular_rate_rad_s);
    }
    times_s_.push_back(time_s);
    rates_rad_s_.push_back(sample.angular_rate_rad_s);
    sums_rad_.push_back(sum);
  }
  constexpr double kGapSteps = 5.0, kMinGap_s = 0.01;
  const double gap_s = std::max(kMinGap_s, kGapSteps * medianOf(steps_s));
  for (std::size_t k = 1; k < times_s_.size(); ++k) {
    if (times_s_[k] - times_s_[k - 1] > gap_s) gaps_s_.push_back(times_s_[k - 1]);
  }
}

std::size_t SummedRates::after(double time_s) const {
  const auto found = std::upper_bound(times_s_.begin(), times_s_.end(), time_s) - times_s_.begin();
  return std::clamp<std::size_t>(static_cast<std::size_t>(found), 1, times_s_.size() - 1);
}

bool SummedRates::covers(double from_s, double to_s) const {
  if (times_s_.size() < 2 || from_s < times_s_.front() || to_s > times_s_.back()) return false;
  // The last gap that begins before the end must have ended before the beginning.
  const auto gap = std::lower_bound(gaps_s_.begin(), gaps_s_.end(), to_s);
  return gap == gaps_s_.begin() || times_s_[after(*(gap - 1))] <= from_s;
}

Eigen::Vector3d SummedRates::rateAt_rad_s(double time_s) const {
  const std::size_t k = after(time_s);
  const double part = (time_s - times_s_[k - 1]) / (times_s_[k] - times_s_[k - 1]);
  return rates_rad_s_[k - 1] + part * (rates_rad_s_[k] - rates_rad_s_[k - 1]);
}

Eigen::Vector3d SummedRates::sumUntil(double time_s) const {
  const std::size_t k = after(time_s);
  const double since_s = time_s - times_s_[k - 1];
  return sums_rad_[k - 1] + 0.5 * since_s * (rates_rad_s_[k - 1] + rateAt_rad_s(time_s));
}

}  // namespace evical
