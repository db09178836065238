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

}  // namespace evical
