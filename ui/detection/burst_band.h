// SPDX-License-Identifier: GPL-3.0-or-later
// Edge bursts around the cursor, from cached events. Up to ten seconds are kept, so that stepping and playing
// only add new ones. A jump costs one front-end history of events: 0.7 s.
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

  // Provides at least all bursts with begin_ns <= time < end_ns. False: the recording is not yet read that
  // far, and history() has only the existing ones.
  bool cover(std::int64_t begin_ns, std::int64_t end_ns);
  const BurstHistory& history() const { return history_; }

 private:
  void restart(std::int64_t begin_ns);
  void feedUntil(std::int64_t end_ns);

  std::shared_ptr<const EventCache> cache_;
  Resolution resolution_px_;
  BurstOptions options_;
  std::int64_t lead_ns_, lag_ns_;            // time before and after a burst in which events affect it
  std::optional<BurstExtractor> extractor_;  // null once finished
  BurstHistory history_;
  std::int64_t covered_from_ns_ = 0, fed_until_ns_ = 0;
  bool running_ = false;
  std::vector<Event> events_;
  std::vector<EdgeCrossing> bursts_;
};

}  // namespace evical::ui
