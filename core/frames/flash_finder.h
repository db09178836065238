// Detection of the board in counts of flashes, and measurement of its points in the sensor's own pixels.
#pragma once

#include "core/frames/board_finder.h"
#include "core/frames/flash_gathering.h"
#include "core/frames/frame_options.h"

#include <optional>
#include <string>

namespace evical {

class FlashFinder {
 public:
  FlashFinder(const Board& board, Resolution size_px, const FrameOptions& frames,
              const BlinkOptions& options);

  // Empty if the board is not found. Determines whether ink or paper flashes, and remembers it.
  FoundPoints find(const FlashCounts& sum);
  // The points within the gate of their places in a view close in time; for a checkerboard only those found
  // last, since a part of it does not determine whether there are others.
  FoundPoints measure(const FlashCounts& sum, const FoundPoints& near, double gate_px) const;

  bool renumbered() { return finder_.renumbered(); }
  std::string doubt() const { return finder_.doubt(); }
  std::string remark() const { return finder_.remark(); }

 private:
  FoundPoints onSensor(const GrayImage& picture, const GrayImage& larger, FoundPoints found) const;
  FoundPoints saddles(const GrayImage& picture, const GrayImage& larger, const FoundPoints& found) const;

  Board board_;
  Resolution size_px_;
  int times_;             // enlargement of the searched pictures
  FrameOptions options_;  // for the enlarged pictures
  BoardFinder finder_;
  std::optional<Flashing> flashing_;
  FoundPoints last_found_;
};

}  // namespace evical
