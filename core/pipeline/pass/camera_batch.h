// What the reading thread hands to the window thread: what one camera saw.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/frontend/edge_crossings.h"
#include "core/geometry/resolution.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

struct CameraBatch {
  std::size_t camera = 0;
  std::vector<EdgeCrossing> bursts;
  std::int64_t first_event_ns = 0, complete_until_ns = 0;
  std::vector<Event> events;  // of a blinking board, in the place of bursts
  std::vector<Frame> frames;
  std::vector<MeasuredPoint> points;  // of one time
  // With a camera's first batch.
  std::optional<Resolution> opened_px;
  CameraKind kind = CameraKind::Events;
  std::int64_t start_ns = 0;
};

}  // namespace evical
