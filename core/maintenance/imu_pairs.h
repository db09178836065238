// Two IMUs on one rigid body: information of each window of time on their rotation, lever arm, time offset
// and biases, as normal equations, so that an hour needs a few megabytes. docs/maths.md, 15.3.
#pragma once

#include "core/data/calibration_state.h"
#include "core/data/imu_sample.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace evical {

// Gaussian smoothing of an IMU's samples, at any time: linear and the same for all IMUs, so that relations
// between their signals are also valid for the smoothed ones, for any sampling. For equidistant samples and a
// sigma of at least two intervals, the sum equals the integral to better than 1e-15: nothing is interpolated.
struct SmoothPoint {
  Eigen::Vector3d rate_rad_s, rate_slope_rad_s2, force_m_s2, force_slope_m_s3;
  Eigen::Matrix3d rate_products;  // of the rates' components, for centripetal accelerations
};

class GaussianSmoother {
 public:
  explicit GaussianSmoother(double sigma_s) : sigma_s_(sigma_s) {}

  double reach_s() const { return 5.0 * sigma_s_; }

  // In order of time; samples out of order are dropped. Each sensor is smoothed over its own samples.
  void add(double time_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2,
           MeasuredBy measured_by = MeasuredBy::Both);
  // Empty if samples are missing.
  std::optional<SmoothPoint> at(double time_s) const;
  void forgetBefore(double time_s);  // earlier times will not be requested any more

  bool empty() const { return rates_.empty() || forces_.empty(); }
  double latest_s() const { return std::min(rates_.back().time_s, forces_.back().time_s); }

 private:
  struct Sample {
    double time_s;
    Eigen::Vector3d value;
  };
  // Smoothed values of one sensor: mean, slope, and products of components.
  struct Smoothed {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  };
  std::optional<Smoothed> at(double time_s, const std::deque<Sample>& samples) const;

  double sigma_s_;
  std::deque<Sample> rates_, forces_;
};

struct MaintenanceOptions;

// Order: rotation (about the reference's axes) [rad], translation [m], time offset [s], gyroscope's bias
// [rad/s], accelerometer's bias [m/s^2]; the biases in the IMU's own frame, as its excess over the
// reference's measurement.
inline constexpr Eigen::Index kPairNumbers = 13;
using PairVector = Eigen::Matrix<double, kPairNumbers, 1>;
using PairMatrix = Eigen::Matrix<double, kPairNumbers, kPairNumbers>;

// Normal equations of one sensor, with unit weights, linearised at the nominal pair.
struct PairEquations {
  PairMatrix information = PairMatrix::Zero();
  PairVector score = PairVector::Zero();
  double squares = 0.0;  // of residuals at the nominal pair
  int count = 0;         // number of residuals

  void add(const Eigen::Matrix<double, 3, kPairNumbers>& jacobian, const Eigen::Vector3d& residual);
};

struct PairWindow {
  double time_s = 0.0;  // its begin, on the reference's clock
  PairEquations gyroscope, accelerometer;
};

// Linearisation point of the windows.
struct PairNominal {
  RigidTransform reference_from_imu;
  double time_offset_s = 0.0, time_offset_drift_ppm = 0.0, time_offset_at_s = 0.0;
};

class ImuPairs {
 public:
  // The first IMU is the reference; intrinsics and biases are those of `imus`, poses and clocks those of
  // `nominal`.
  ImuPairs(std::vector<ImuState> imus, std::vector<PairNominal> nominal, double smoothing_s,
           const MaintenanceOptions& options);

  // On the IMU's own clock, in order of time; IMUs alternate, as in a log.
  void add(std::size_t imu, double time_s, const ImuSample& sample);
  void finish();

  // By IMU; empty for the reference.
  const std::vector<std::vector<PairWindow>>& windows() const { return windows_; }
  double pointInterval_s() const { return interval_s_; }

 private:
  void advance(double until_s);
  void compare(double time_s);
  void addPoint(std::size_t imu, double time_s, const SmoothPoint& reference, const SmoothPoint& own);

  std::vector<ImuState> imus_;
  std::vector<PairNominal> nominal_;
  double window_s_, interval_s_;
  std::vector<GaussianSmoother> smoothers_;
  std::vector<std::vector<PairWindow>> windows_;
  double next_s_ = 0.0;
  bool started_ = false;
};

// Sigma of the smoothing: smoothing_s, or two samples of the slowest IMU.
double smoothingFor(double slowest_rate_hz, const MaintenanceOptions& options);

}  // namespace evical
