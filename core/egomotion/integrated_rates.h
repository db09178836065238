// Gyroscope samples, summed over time: means over any stretch, which change smoothly with its beginning and
// end.
#pragma once

#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace evical {

class SummedRates {
 public:
  // Times become seconds since start_ns. Samples in time order.
  SummedRates(std::span<const ImuSample> samples, std::int64_t start_ns);

  // Between samples that are not far apart.
  bool covers(double from_s, double to_s) const;
  // Linear between samples. Where it covers.
  Eigen::Vector3d rateAt_rad_s(double time_s) const;
  Eigen::Vector3d mean_rad_s(double from_s, double to_s) const {
    return (sumUntil(to_s) - sumUntil(from_s)) / (to_s - from_s);
  }

 private:
  std::size_t after(double time_s) const;  // index of the first sample behind; 1 .. size - 1
  Eigen::Vector3d sumUntil(double time_s) const;

  std::vector<double> times_s_, gaps_s_;  // gaps: begins of steps that are too long
  std::vector<Eigen::Vector3d> rates_rad_s_, sums_rad_;
};

}  // namespace evical
