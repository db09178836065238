// Rotation from the gyroscope only (docs/maths.md, 8.1): integrated between samples, up to an initial
// rotation and a bias.
#pragma once

#include "core/data/imu_sample.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <span>
#include <vector>

namespace evical {

class GyroRotation {
 public:
  // Times are converted to seconds since start_ns. Samples in time order, at least two.
  GyroRotation(std::span<const ImuSample> samples, std::int64_t start_ns,
               const Eigen::Vector3d& bias_rad_s = Eigen::Vector3d::Zero());

  double begin_s() const { return times_s_.front(); }
  double end_s() const { return times_s_.back(); }
  bool covers(double from_s, double to_s) const { return from_s >= begin_s() && to_s <= end_s(); }

  // first_from_imu: rotation since the first sample; between samples at constant rate.
  Eigen::Quaterniond at(double time_s) const;
  // Rotation vector of imu(from)_from_imu(to).
  Eigen::Vector3d between(double from_s, double to_s) const;

  // About its mean, which may be a bias, and without frequencies above 20 Hz, which may be noise.
  double rateRms_rad_s() const;
  // Longest time between two samples, and its beginning.
  double longestGap_s(double* begin_s = nullptr) const;

 private:
  std::vector<double> times_s_;
  std::vector<Eigen::Quaterniond> rotations_;
};

}  // namespace evical
