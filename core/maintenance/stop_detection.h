// Detection of intervals in which an IMU is at rest, from its own measurements.
#pragma once

#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

struct MaintenanceOptions;

// Means over a quarter of a second: sufficient for stops, so that memory grows by a megabyte per hour.
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
  void finish();  // ends the input

  const std::vector<MeansWindow>& windows() const { return windows_; }

 private:
  void close();

  std::vector<MeansWindow> windows_;
  bool open_ = false;
  MeansWindow current_;  // sums, relative to the first sample's values
  Eigen::Vector3d rate_origin_, force_origin_;
};

// Indices of a stop's windows, both inclusive, without those in which it begins and ends.
struct StopRange {
  std::size_t first = 0, last = 0;
  std::size_t count() const { return last - first + 1; }
};
// `above_quietest`: a window counts as still up to this multiple of the accelerometer's variance in the log's
// quietest tenth.
std::vector<StopRange> findStops(std::span<const MeansWindow> windows, double above_quietest,
                                 const MaintenanceOptions& options);

// Ratio of gravity's rotation in the accelerometer to the gyroscope's: near 1, or near 0.017 if rates are in
// deg/s instead of rad/s. 0 if there is too little rotation.
double rateScale(std::span<const MeansWindow> windows);

}  // namespace evical
