#include "core/frames/half_periods.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace evical {

// A turn shows as soon as the new events outweigh the old in the smoothed bins: halfway through these where a pixel
// fires all the time, at once where it fires in short bursts.
bool HalfPeriods::add(double balance) {
  constexpr double kClear = 0.15;  // of what the last two periods reached
  last_[count_ % kSmoothed] = balance;
  const double smooth = std::accumulate(last_.begin(), last_.end(), 0.0);
  heights_[count_ % heights_.size()] = std::abs(smooth);
  ++count_;
  const double height = *std::max_element(heights_.begin(), heights_.end());
  const int sign = smooth > kClear * height ? 1 : smooth < -kClear * height ? -1 : 0;
  return sign != 0 && std::exchange(sign_, sign) == -sign;
}

}  // namespace evical
