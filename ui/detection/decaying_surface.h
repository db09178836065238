// SPDX-License-Identifier: GPL-3.0-or-later
// Surface of active events at the cursor, kept between pictures: while the cursor advances, only the events
// since the last picture are read. Not thread-safe.
#pragma once

#include "ui/detection/event_cache.h"
#include "ui/detection/surface_frame.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace evical::ui {

class DecayingSurface {
 public:
  // The unfaded events before time_ns, drawn like renderEvents().
  SurfaceFrame render(const std::shared_ptr<const EventCache>& cache, std::int64_t time_ns,
                      Resolution resolution_px, const SurfaceStyle& style);

 private:
  void add(std::int64_t begin_ns, std::int64_t end_ns);

  std::shared_ptr<const EventCache> cache_;
  Resolution resolution_px_;
  std::int64_t base_ns_ = 0;   // zero of the times in newest_
  std::int64_t begin_ns_ = 0;  // newest_ has all events of [begin_ns_, end_ns_)
  std::int64_t end_ns_ = 0;
  std::vector<std::int32_t> newest_;  // as in SurfaceFrame
  std::vector<Event> events_;
};

}  // namespace evical::ui
