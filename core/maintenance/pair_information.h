// Windows of two IMUs, weighted by the noise of their own residuals, and without the information that noise
// imitates: docs/maths.md, 15.3.
#pragma once

#include "core/maintenance/pair_tracking.h"

#include <span>
#include <vector>

namespace evical {

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
