// SPDX-License-Identifier: GPL-3.0-or-later
// Bursts around the cursor, taken from cached events: up to ten seconds are kept, so that stepping and
// playing only add what is new. A jump costs what the front end's own history costs: 0.7 s of events.
#pragma once

#include "core/frontend/burst_window.h"
#include "core/frontend/edge_crossings.h"
#include "ui/detection/event_cache.h"

#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {

class BurstBand {
 public:
  BurstBand(std::shared_ptr<const EventCache> cache, Resolution resolution_px, const BurstOptions& options);

  // All bursts with begin_ns <= time < end_ns, and others. False: the recording is not read that far yet;
  // what there is can be asked for.
  bool cover(std::int64_t begin_ns, std::int64_t end_ns);
  const BurstHistory& history() const { return history_; }

 private:
  void restart(std::int64_t begin_ns);
  void feedUntil(std::int64_t end_ns);

  std::shared_ptr<const EventCache> cache_;
  Resolution resolution_px_;
  BurstOptions options_;
  std::int64_t lead_ns_, lag_ns_;            // events before and after a burst's time that decide about it
  std::optional<BurstExtractor> extractor_;  // null once finished
  BurstHistory history_;
  std::int64_t covered_from_ns_ = 0, fed_until_ns_ = 0;
  bool running_ = false;
  std::vector<Event> events_;
  std::vector<EdgeCrossing> bursts_;
};

}  // namespace evical::ui
