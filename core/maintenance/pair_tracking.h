// How two IMUs lie to each other over time, and when that changed: a filter over windows, and at each of them the
// question whether anything has changed since one of those before. docs/maths.md, 15.4.
#pragma once

#include "core/maintenance/imu_pairs.h"
#include "core/maintenance/noise_autocorrelation.h"
#include "core/numerics/change_test.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace evical {

inline constexpr std::array<StateBlock, 5> kPairBlocks = {{{0, 3}, {3, 3}, {6, 1}, {7, 3}, {10, 3}}};

struct PairModel {
  double gyroscope_walk = 0.0, accelerometer_walk = 0.0;  // of the two IMUs' biases together, per root second
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
  // Of the log until the first change, against the nominal pair, with nothing known before.
  PairVector start = PairVector::Zero();
  PairMatrix start_covariance = PairMatrix::Zero(), start_information = PairMatrix::Zero();
  PairVector start_score = PairVector::Zero();
  std::vector<PairStep> steps;
  double gyroscope_noise_rad_s = 0.0, accelerometer_noise_m_s2 = 0.0;  // of a point
  // By how much variances are larger than white noise makes them, by block: sigmas above hold it, information does not.
  std::array<NoiseAutocorrelation, kPairBlocks.size()> colours;
};

// `alarm_probability`: that of a false alarm in all of this pair's tests together.
PairTrack trackPair(std::span<const PairWindow> windows, const PairModel& model, double alarm_probability,
                    const MaintenanceOptions& options);

// What may change by itself, as variances.
PairVector pairStability(const MaintenanceOptions& options);

}  // namespace evical
