#include "core/frontend/polarity_delay.h"

#include <algorithm>
#include <cmath>

namespace evical {

void PolarityDelayFit::add(double speed_px_s, double radius_offset_px) {
  constexpr double kSlow_px_s = 20.0;  // bursts of slower edges are displaced (docs/maths.md, 9.1)
  if (!(speed_px_s >= kSlow_px_s)) return;
  count_ += 1.0;
  speed_ += speed_px_s;
  offset_ += radius_offset_px;
  speed2_ += speed_px_s * speed_px_s;
  offset2_ += radius_offset_px * radius_offset_px;
  product_ += speed_px_s * radius_offset_px;
}

std::optional<PolarityDelay> PolarityDelayFit::result(CircleShade shade) const {
  constexpr double kLeastWindows = 20.0, kLeastSpread_px_s = 5.0;
  if (count_ < kLeastWindows) return std::nullopt;
  const double spread = speed2_ - speed_ * speed_ / count_;
  if (!(spread > count_ * kLeastSpread_px_s * kLeastSpread_px_s)) return std::nullopt;
  const double slope_s = (product_ - speed_ * offset_ / count_) / spread;
  const double scatter2 = std::max(0.0, offset2_ - offset_ * offset_ / count_ - slope_s * slope_s * spread);
  const double sigma_s = std::sqrt(scatter2 / ((count_ - 2.0) * spread));
  const double sign = shade == CircleShade::Dark ? 1.0 : -1.0;
  return PolarityDelay{2.0 * sign * slope_s, 2.0 * sigma_s};
}

}  // namespace evical
