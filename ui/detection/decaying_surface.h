// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of active events at the cursor, kept from one picture to the next: while the cursor goes on,
// only the events since the last picture are read. For one thread.
#pragma once

#include "ui/detection/event_cache.h"
#include "ui/detection/surface_frame.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace evical::ui {

class DecayingSurface {
 public:
  // The events before time_ns that have not faded yet, as renderEvents() would draw them.
  SurfaceFrame render(const std::shared_ptr<const EventCache>& cache, std::int64_t time_ns,
                      Resolution resolution_px, const SurfaceStyle& style);

 private:
  void add(std::int64_t begin_ns, std::int64_t end_ns);

  std::shared_ptr<const EventCache> cache_;
  Resolution resolution_px_;
  std::int64_t base_ns_ = 0;   // what newest_ counts from
  std::int64_t begin_ns_ = 0;  // all events from here to the next are in newest_
  std::int64_t end_ns_ = 0;
  std::vector<std::int32_t> newest_;  // as in SurfaceFrame
  std::vector<Event> events_;
};

}  // namespace evical::ui
