// Whose time offsets are uncertain by what is not known of pixels' delay.
#pragma once

#include "core/data/board_observations.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace evical {

// Events are late by their pixels' delay, and nothing in the recording tells by how much; so is an event camera's time
// offset against sensors of other kinds. Where all is measured by such pixels, nothing is.
inline bool holdsPixelDelay(std::span<const CameraKind> cameras, std::size_t camera, bool has_imus) {
  const auto hasEvents = [](CameraKind kind) { return kind == CameraKind::Events; };
  return hasEvents(cameras[camera]) && (has_imus || !std::all_of(cameras.begin(), cameras.end(), hasEvents));
}

// What is left of such an offset's variance without a delay that is the same every time; never less than a tenth of it,
// for the delay is not known so well.
inline double withoutPixelDelay_s2(double variance_s2, double delay_s) {
  constexpr double kLeast = 0.1;
  return std::max(variance_s2 - delay_s * delay_s, kLeast * variance_s2);
}

}  // namespace evical
