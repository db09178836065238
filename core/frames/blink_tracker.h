// Views of a blinking board from events: the blink is detected, flashes are summed to pictures, and the board
// is detected in these as in frames (docs/maths.md, 7.5).
#pragma once

#include "core/data/board_observations.h"
#include "core/frames/blink.h"
#include "core/frames/flash_finder.h"
#include "core/frames/flash_gathering.h"
#include "core/frames/frame_options.h"
#include "core/frames/views_from_frames.h"
#include "core/geometry/board.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

class BlinkTracker {
 public:
  // Throws CalibrationError (BadInput) if the board is invalid.
  BlinkTracker(std::string camera, const Board& board, Resolution resolution_px, const FrameOptions& frames,
               const BlinkOptions& options, std::int64_t start_ns);
  BlinkTracker(const BlinkTracker&) = delete;
  BlinkTracker& operator=(const BlinkTracker&) = delete;

  // Events in order of time, inside the resolution.
  void add(EventSpan events);

  // The windows so far; views are available at the end.
  const BoardObservations& soFar() const { return so_far_; }

  // In the sensor's own pixels. Throws CalibrationFailed if no blinking is detected.
  BoardObservations finish();

  const std::optional<Blink>& blink() const { return notice_.blink(); }
  std::string doubt() const { return finder_.doubt(); }
  std::string remark() const { return finder_.remark(); }

 private:
  void gather(EventSpan events);
  void see(const FlashSlot& slot);
  FoundPoints follow(const FlashCounts& whole, double time_s);
  FoundPoints withoutMotion(const FlashSlot& slot, FoundPoints found, WindowReport& window) const;
  void dropEarlier();
  void keep(FoundPoints points, WindowReport window);

  std::string camera_;
  Board board_;
  Resolution resolution_px_;
  FrameOptions frames_;
  BlinkOptions options_;
  std::int64_t start_ns_;
  BlinkNotice notice_;
  FlashFinder finder_;
  std::optional<FlashGathering> gathering_;
  std::vector<PointsInFrame> seen_;
  int followed_ = 0;  // slots since the last search
  std::size_t searched_points_ = 0,
              max_points_ = 0;  // points of the last search, and the most of any search
  BoardObservations so_far_;
};

}  // namespace evical
