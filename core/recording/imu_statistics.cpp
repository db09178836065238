#include "core/recording/imu_statistics.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>

namespace evical {

double medianInterval_s(const std::vector<ImuSample>& samples) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    intervals_s.push_back(secondsSince(samples[i - 1].time_ns, samples[i].time_ns));
  }
  return medianOf(std::move(intervals_s));
}

double medianForceNorm(const std::vector<ImuSample>& samples) {
  std::vector<double> norms;
  for (const ImuSample& sample : samples) {
    const double norm = sample.specific_force_m_s2.norm();
    if (std::isfinite(norm)) norms.push_back(norm);
  }
  return medianOf(std::move(norms));
}

double largestRate(const std::vector<ImuSample>& samples) {
  double largest = 0.0;
  for (const ImuSample& sample : samples) {
    const double rate = sample.angular_rate_rad_s.cwiseAbs().maxCoeff();
    if (std::isfinite(rate)) largest = std::max(largest, rate);
  }
  return largest;
}

}  // namespace evical
