// Integrated gyroscope samples: means over any interval, which are smooth functions of its beginning and end.
#pragma once

#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace evical {

class SummedRates {
 public:
  // Times are converted to seconds since start_ns. Samples in time order.
  SummedRates(std::span<const ImuSample> samples, std::int64_t start_ns);

  // True if samples without a long gap cover the interval.
  bool covers(double from_s, double to_s) const;
  // Linearly interpolated. Only within the covered time.
  Eigen::Vector3d rateAt_rad_s(double time_s) const;
  Eigen::Vector3d mean_rad_s(double from_s, double to_s) const {
    return (sumUntil(to_s) - sumUntil(from_s)) / (to_s - from_s);
  }

 private:
  std::size_t after(double time_s) const;  // index of the first later sample; 1 .. size - 1
  Eigen::Vector3d sumUntil(double time_s) const;

  std::vector<double> times_s_, gaps_s_;  // gaps_s_: beginnings of too long steps
  std::vector<Eigen::Vector3d> rates_rad_s_, sums_rad_;
};

}  // namespace evical
