// SPDX-License-Identifier: GPL-3.0-or-later
// Copies of the detections so far, for pages that show them while detection goes on.
#pragma once

#include "core/data/board_observations.h"
#include "ui/jobs/mailbox.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

namespace evical::ui {

// By camera, never null. Copies are shared and never changed.
using LiveDetections = std::vector<std::shared_ptr<const BoardObservations>>;

// A copy takes longer the longer the recording is, so copies become less frequent: they take at most a twentieth of the
// detecting thread's time.
class DetectionCopies {
 public:
  explicit DetectionCopies(std::size_t cameras)
      : copies_(cameras, std::make_shared<const BoardObservations>()) {}

  void take(std::size_t camera, const BoardObservations& so_far, Mailbox<LiveDetections>& to) {
    const Clock::time_point begin = Clock::now();
    if (begin < next_) return;
    copies_.at(camera) = std::make_shared<const BoardObservations>(so_far);
    to.put(std::make_shared<LiveDetections>(copies_));
    const Clock::time_point end = Clock::now();
    next_ = end + std::max<Clock::duration>(kBetween, kLeastRest * (end - begin));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kBetween{150};
  static constexpr int kLeastRest = 20;  // times the duration of a copy

  LiveDetections copies_;
  Clock::time_point next_;
};

}  // namespace evical::ui
