// Uncertainty of time offsets due to the unknown delay of pixels.
#pragma once

#include "core/data/board_observations.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace evical {

// True if a time offset contains the pixels' delay: events are late by it, and the recording does not
// determine it. It affects an event camera's offset relative to other kinds of sensors, and cancels if all
// sensors have such pixels.
inline bool holdsPixelDelay(std::span<const CameraKind> cameras, std::size_t camera, bool has_imus) {
  const auto hasEvents = [](CameraKind kind) { return kind == CameraKind::Events; };
  return hasEvents(cameras[camera]) && (has_imus || !std::all_of(cameras.begin(), cameras.end(), hasEvents));
}

// Variance of such an offset without the delay, if the delay is the same every time; at least a tenth of the
// variance, since the delay is uncertain.
inline double withoutPixelDelay_s2(double variance_s2, double delay_s) {
  constexpr double kMin = 0.1;
  return std::max(variance_s2 - delay_s * delay_s, kMin * variance_s2);
}

}  // namespace evical
