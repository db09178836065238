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
  double squares = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double time_s = secondsSince(start_ns, samples[k].time_ns);
    if (k > 0) {
      const Eigen::Vector3d mean =
          0.5 * (samples[k - 1].angular_rate_rad_s + samples[k].angular_rate_rad_s) - bias_rad_s;
      rotation = (rotation * quaternionExp(mean * (time_s - times_s_.back()))).normalized();
    }
    times_s_.push_back(time_s);
    rotations_.push_back(rotation);
    squares += (samples[k].angular_rate_rad_s - bias_rad_s).squaredNorm();
  }
  rate_rms_rad_s_ = std::sqrt(squares / static_cast<double>(samples.size()));
}

Eigen::Quaterniond GyroRotation::at(double time_s) const {
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
  if (after == times_s_.begin()) return rotations_.front();
  if (after == times_s_.end()) return rotations_.back();
  const auto k = static_cast<std::size_t>(after - times_s_.begin());
  const double part = (time_s - times_s_[k - 1]) / (times_s_[k] - times_s_[k - 1]);
  return rotations_[k - 1].slerp(part, rotations_[k]);
}

Eigen::Vector3d GyroRotation::between(double from_s, double to_s) const {
  return quaternionLog(at(from_s).conjugate() * at(to_s));
}

}  // namespace evical
