#include "core/initialisation/gyro_rotation.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"

#include <algorithm>
#include <cmath>

namespace evical {

GyroRotation::GyroRotation(std::span<const ImuSample> samples, std::int64_t start_ns,
                           const Eigen::Vector3d& bias_rad_s) {
  times_s_.reserve(samples.size());
  rotations_.reserve(samples.size());
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double time_s = secondsSince(start_ns, samples[k].time_ns);
    if (k > 0) {
      const Eigen::Vector3d mean =
          0.5 * (samples[k - 1].angular_rate_rad_s + samples[k].angular_rate_rad_s) - bias_rad_s;
      rotation = (rotation * quaternionExp(mean * (time_s - times_s_.back()))).normalized();
    }
    times_s_.push_back(time_s);
    rotations_.push_back(rotation);
  }
}

Eigen::Quaterniond GyroRotation::at(double time_s) const {
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
  if (after == times_s_.begin()) return rotations_.front();
  if (after == times_s_.end()) return rotations_.back();
  const auto k = static_cast<std::size_t>(after - times_s_.begin());
  const double part = (time_s - times_s_[k - 1]) / (times_s_[k] - times_s_[k - 1]);
  return rotations_[k - 1].slerp(part, rotations_[k]);
}

double GyroRotation::rateRms_rad_s() const {
  constexpr double kStep_s = 0.05;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  int count = 0;
  for (double time_s = begin_s(); time_s + kStep_s <= end_s(); time_s += kStep_s) {
    const Eigen::Vector3d rate = between(time_s, time_s + kStep_s) / kStep_s;
    sum += rate;
    squares += rate.squaredNorm();
    ++count;
  }
  if (count == 0) return 0.0;
  return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()));
}

double GyroRotation::longestGap_s(double* begin_s) const {
  double longest_s = 0.0;
  for (std::size_t k = 1; k < times_s_.size(); ++k) {
    if (times_s_[k] - times_s_[k - 1] <= longest_s) continue;
    longest_s = times_s_[k] - times_s_[k - 1];
    if (begin_s) *begin_s = times_s_[k - 1];
  }
  return longest_s;
}

Eigen::Vector3d GyroRotation::between(double from_s, double to_s) const {
  return quaternionLog(at(from_s).conjugate() * at(to_s));
}

}  // namespace evical
