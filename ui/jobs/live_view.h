// SPDX-License-Identifier: GPL-3.0-or-later
// Intermediate results of a calibration, between core's threads and the GUI.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/calibration_observer.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_state.h"

#include <QString>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

// Passes the newest value of a worker to the GUI thread. Older values that were not taken are dropped, so
// that a slow window never builds up a queue.

namespace evical::ui {

template <class Value>
class Mailbox {
 public:
  // For receivers that poll.
  Mailbox() = default;
  // `tell` is called from the sending thread when there is a new value, once until it is taken; it must only
  // forward the message.
  explicit Mailbox(std::function<void()> tell) : tell_(std::move(tell)) {}

  void put(std::shared_ptr<const Value> value) {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(value);
    if (!std::exchange(pending_, true) && tell_) tell_();
  }

  // The newest value, even if it was taken before; null if there was none.
  std::shared_ptr<const Value> take() {
    const std::lock_guard lock(mutex_);
    pending_ = false;
    return newest_;
  }
  // Null if the newest value was taken before.
  std::shared_ptr<const Value> takeNew() {
    const std::lock_guard lock(mutex_);
    return std::exchange(pending_, false) ? newest_ : nullptr;
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    newest_ = nullptr;
    pending_ = false;
  }
  // Ends the notifications: the receiver is about to be destroyed.
  void close() {
    const std::lock_guard lock(mutex_);
    tell_ = nullptr;
  }

 private:
  std::mutex mutex_;
  std::function<void()> tell_;
  std::shared_ptr<const Value> newest_;
  bool pending_ = false;
};

// Views are copied once and never changed; a list of them needs one pointer per view.
using SharedViews = std::vector<std::shared_ptr<const BoardView>>;
SharedViews sharedViews(const std::shared_ptr<const BoardObservations>& observations);

struct LiveCamera {
  std::size_t windows = 0;
  SharedViews views;
};
using LiveDetections = std::vector<LiveCamera>;  // by camera

struct LiveIterations {
  std::vector<IterationRecord> records;  // all until now
  CalibrationState state;                // after the last of them
};

struct InitialisationNote {
  QString step, subject, result;
  double duration_s = 0.0;
};

// A pass over the recording, and the resulting lens.
struct LensPass {
  int number = 0;
  int views = 0;
  double reprojection_rms_px = 0.0, moved_px = 0.0;
};

class LiveView final : public CalibrationObserver {
 public:
  // `windows`: observer of the front end's windows; may be null. `only`: the session's camera that core has
  // as its first one; none: core has all of them.
  LiveView(std::size_t cameras, std::shared_ptr<CalibrationObserver> windows,
           std::optional<std::size_t> only = {})
      : windows_(std::move(windows)), only_(only), detected_(cameras) {}

  FrontEndObserver* windowObserver(std::size_t camera, const BoardTracker& tracker) override;
  void windowsDetected(std::size_t camera, const BoardObservations& so_far) override;
  void detectionDone(const CalibrationInput&) override { detection_done = true; }
  void intrinsicsPassDone(int pass, const IntrinsicsResult& so_far) override;
  void initialisationStepDone(std::string_view step, std::string_view subject, std::string_view result,
                              double duration_s) override;
  void iterationDone(const IterationRecord& iteration, const CalibrationState& state) override;

  Mailbox<LiveDetections> detections;
  std::atomic<bool> detection_done = false;
  Mailbox<std::vector<LensPass>> passes;           // all until now
  Mailbox<std::vector<InitialisationNote>> notes;  // all until now
  Mailbox<LiveIterations> iterations;

  // Used by the GUI thread.
  bool said_done = false;
  std::size_t said_notes = 0, said_passes = 0;

 private:
  std::shared_ptr<CalibrationObserver> windows_;
  std::optional<std::size_t> only_;
  LiveDetections detected_;
  std::chrono::steady_clock::time_point detected_next_;
  std::vector<LensPass> passes_;
  std::vector<InitialisationNote> notes_;
  std::vector<IterationRecord> records_;
};

}  // namespace evical::ui
