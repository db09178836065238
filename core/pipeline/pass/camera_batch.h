// Data of one camera that the reading thread passes to the window thread.
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
  std::vector<Event> events;  // for a blinking board, instead of bursts
  std::vector<Frame> frames;
  std::vector<MeasuredPoint> points;  // with the same timestamp
  // Set in a camera's first batch.
  std::optional<Resolution> opened_px;
  CameraKind kind = CameraKind::Events;
  std::int64_t start_ns = 0;
};

}  // namespace evical
