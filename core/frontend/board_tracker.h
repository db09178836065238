// The front end over time: events in, board views out, in bounded memory. The board is searched once, then
// tracked from window to window; windows before the detection are tracked backwards. Tracking
// keeps checking the placement, and replaces it if windows contradict it.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/edge_crossings.h"
#include "core/frontend/rival_placements.h"
#include "core/frontend/window_trace.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace evical {

struct BoardSearch;

class BoardTracker {
 public:
  // Times in the observations are seconds since start_ns. Without a camera all pixels are the sensor's own.
  BoardTracker(const Board& board, Resolution resolution_px, std::optional<CameraIntrinsics> camera,
               const FrontEndOptions& options, std::int64_t start_ns);

  // Events in time order, inside the resolution.
  void add(EventSpan events);
  // The same for a caller that extracts bursts elsewhere, for example in another thread: the output of a
  // BurstExtractor, and its completeUntil_ns() after it.
  void addBursts(const std::vector<EdgeCrossing>& bursts, std::int64_t first_event_ns,
                 std::int64_t complete_until_ns);
  BoardObservations finish();

  // Why the board may be another one than stated, and what of its print is unusual; empty if nothing is
  // known.
  std::string doubt() const;
  std::string remark() const;

  void stopWith(std::stop_token stop) { stop_ = std::move(stop); }        // skips the remaining windows
  void observeWith(FrontEndObserver* observer) { observer_ = observer; }  // not owned; may be null

  const BoardScene& scene() const { return scene_; }
  const BurstHistory& history() const { return history_; }
  // Views so far; complete except for windows that may still be found by backwards tracking.
  const BoardObservations& observations() const { return observations_; }

 private:
  void processWindows();
  WindowSlot nextSlot() const;
  void skipEmptyTime(std::int64_t until_ns);
  void processSlot(const WindowSlot& slot);
  BoardSearch searchWindow(std::int64_t middle_ns);
  void useSingleEvents(bool use);
  void searchNearPrediction(std::int64_t middle_ns);
  void acquire(const WindowSlot& slot, const BoardMotion& motion, bool distinguished);
  void trackBackwards(const WindowSlot& from, BoardMotion motion);
  WindowTrace track(const WindowSlot& slot, const BoardMotion& last);
  void reconsiderPlacement(const WindowSlot& slot, WindowTrace& trace);
  void renumberTrack(const Eigen::Matrix3d& shift);
  void endTrack();
  WindowReport& reportOf(const BoardView& view);
  void keep(WindowTrace& trace);
  void miss(const WindowSlot& slot, const BoardSearch* search);
  std::int64_t slotLength_ns(const BoardMotion* motion) const;

  BoardScene scene_;
  FrontEndOptions given_options_, options_;  // the present ones may be for single events
  std::int64_t start_ns_;
  std::optional<BurstExtractor> extractor_;  // only if the input is events, not bursts
  BurstHistory history_;
  BurstWindow window_;
  std::int64_t complete_until_ns_;
  std::int64_t last_burst_ns_;
  std::vector<EdgeCrossing> new_bursts_;
  std::optional<BoardMotion> motion_;  // last tracked window
  std::int64_t next_begin_ns_ = 0;     // of the next slot
  std::int64_t last_search_ns_;
  double search_interval_s_;       // grows while searches fail
  std::int64_t tracked_until_ns_;  // end of the last tracked slot
  std::stop_token stop_;
  FrontEndObserver* observer_ = nullptr;
  bool started_ = false;
  int other_patterns_ = 0;                      // searches that found corners, but other tags between them
  std::optional<std::pair<int, int>> numbers_;  // the first and the last one of those tags
  int held_windows_ = 0;
  PlacementWatch placement_watch_;
  PolarityDelayFit polarity_delay_;
  std::size_t open_begin_ = 0;  // first view since the board was found, or since its placement was confirmed
  BoardObservations observations_;
};

}  // namespace evical
