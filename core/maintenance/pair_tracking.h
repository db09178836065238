// Relative pose and clock of two IMUs over time, and the times of changes: a filter over windows, with a test
// at each of them for a change since one of the previous windows. docs/maths.md, 15.4.
#pragma once

#include "core/maintenance/imu_pairs.h"

#include "core/numerics/change_test.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace evical {

// Excess variance of sums of correlated noise over white noise, for example with a mount that shakes, or an
// engine. docs/maths.md, 15.4.

// Variance ratio for sums over n windows: settled - lost / n, which is valid beyond the noise's correlation
// time.
struct NoiseAutocorrelation {
  double settled = 1.0, lost = 0.0;
  double freedom = 1e9;  // degrees of freedom of the estimate

  double of(std::size_t windows) const;
  double ofMany() const;
  // Limit of chi squared with this many numbers, with the probability that white noise has for `white`:
  // increased for the correlation of noise, and for the uncertainty of that correlation.
  double limit(double white, Eigen::Index numbers, double wider) const;
};

// Statistics of the differences between n windows and the `before` windows in front of them, in units that
// make them chi squared with the given dimension for white noise without changes.
class ColourStatistics {
 public:
  static constexpr std::array<std::size_t, 7> kLengths = {1, 2, 3, 4, 6, 8, 10};  // n

  ColourStatistics(int dimension, std::size_t before) : dimension_(dimension), before_(before) {}

  void add(std::size_t length_index, double statistic) { values_.at(length_index).push_back(statistic); }
  // From medians, which a few changes do not affect; white if there are too few values.
  NoiseAutocorrelation colour() const;

 private:
  int dimension_;
  std::size_t before_;
  std::array<std::vector<double>, kLengths.size()> values_;
};

inline constexpr std::array<StateBlock, 5> kPairBlocks = {{{0, 3}, {3, 3}, {6, 1}, {7, 3}, {10, 3}}};

struct PairModel {
  double gyroscope_walk = 0.0,
         accelerometer_walk = 0.0;  // of the sum of the two IMUs' biases, per root second
  double smoothing_s = 0.02;
  Eigen::Vector3d lever_m = Eigen::Vector3d::Zero();  // of the nominal pair
};

struct PairStep {
  std::size_t block = 0;  // of kPairBlocks
  double at_s = 0.0, noticed_s = 0.0;
  BlockChange change;
  double limit = 0.0;
  std::vector<std::size_t> alternatives;
};

struct PairTrack {
  std::vector<double> times_s;  // ends of windows
  std::vector<PairVector> values, sigmas;
  // From the log until the first change, relative to the nominal pair, without a prior.
  PairVector start = PairVector::Zero();
  PairMatrix start_covariance = PairMatrix::Zero(), start_information = PairMatrix::Zero();
  PairVector start_score = PairVector::Zero();
  std::vector<PairStep> steps;
  double gyroscope_noise_rad_s = 0.0, accelerometer_noise_m_s2 = 0.0;  // of a point
  // Excess of variances over white noise, by block: included in the sigmas above, but not in the information.
  std::array<NoiseAutocorrelation, kPairBlocks.size()> colours;
};

// `alarm_probability`: probability of a false alarm in all tests of this pair.
PairTrack trackPair(std::span<const PairWindow> windows, const PairModel& model, double alarm_probability,
                    const MaintenanceOptions& options);

// Variances of tolerated changes.
PairVector pairStability(const MaintenanceOptions& options);

// Windows of two IMUs, weighted by the noise of their own residuals, and without the information that noise
// imitates: docs/maths.md, 15.3.

// Pair numbers and the offset's drift [s/s]: the state of the filter.
inline constexpr Eigen::Index kPairState = kPairNumbers + 1;
using PairStateVector = Eigen::Matrix<double, kPairState, 1>;
using PairStateMatrix = Eigen::Matrix<double, kPairState, kPairState>;

struct WeighedWindow {
  double time_s = 0.0;
  PairStateMatrix information = PairStateMatrix::Zero();
  PairStateVector score = PairStateVector::Zero();
};

struct WeighedWindows {
  std::vector<WeighedWindow> windows;
  double gyroscope_noise_rad_s = 0.0, accelerometer_noise_m_s2 = 0.0;  // of a point
};

WeighedWindows weighed(std::span<const PairWindow> windows, const PairModel& model,
                       const MaintenanceOptions& options);

}  // namespace evical
