// Intervals over which an IMU stands still, found by its own measurements.
#pragma once

#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

struct MaintenanceOptions;

// Means over a quarter of a second: all that stops need, so that memory grows by a megabyte an hour.
struct MeansWindow {
  double time_s = 0.0;          // start
  int samples = 0, forces = 0;  // of the gyroscope, of the accelerometer
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero(), force_m_s2 = Eigen::Vector3d::Zero();
  double rate_variance = 0.0, force_variance = 0.0;  // within it, per axis
};

class WindowMeans {
 public:
  static constexpr double kLength_s = 0.25;

  void add(double time_s, const ImuSample& sample);
  void finish();  // nothing may be added any more

  const std::vector<MeansWindow>& windows() const { return windows_; }

 private:
  void close();

  std::vector<MeansWindow> windows_;
  bool open_ = false;
  MeansWindow current_;  // of sums, about the first sample's values
  Eigen::Vector3d rate_origin_, force_origin_;
};

// Indices of a stop's windows, both inclusive; those in which it begins and ends are left out.
struct StopRange {
  std::size_t first = 0, last = 0;
  std::size_t count() const { return last - first + 1; }
};
// `above_quietest`: a window counts as still up to this multiple of the accelerometer's variance in the log's quietest tenth.
std::vector<StopRange> findStops(std::span<const MeansWindow> windows, double above_quietest,
                                 const MaintenanceOptions& options);

// How gravity turns in the accelerometer against how the gyroscope says that it turns: near 1, near 0.017 where rates
// are in deg/s and called rad/s. 0 where too little turns.
double rateScale(std::span<const MeansWindow> windows);

}  // namespace evical
