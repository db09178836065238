#include "core/frames/half_periods.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace evical {

// A turn is detected as soon as the new events outweigh the old ones in the smoothed bins: after half of
// these if a pixel fires continuously, immediately if it fires in short bursts.
bool HalfPeriods::add(double balance) {
  constexpr double kClear = 0.15;  // relative to the maximum of the last two periods
  last_[count_ % kSmoothed] = balance;
  const double smooth = std::accumulate(last_.begin(), last_.end(), 0.0);
  heights_[count_ % heights_.size()] = std::abs(smooth);
  ++count_;
  const double height = *std::max_element(heights_.begin(), heights_.end());
  const int sign = smooth > kClear * height ? 1 : smooth < -kClear * height ? -1 : 0;
  return sign != 0 && std::exchange(sign_, sign) == -sign;
}

}  // namespace evical
