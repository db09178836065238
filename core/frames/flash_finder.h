// Finds the board in counts of flashes, and measures its points in the sensor's own pixels.
#pragma once

#include "core/frames/blink_options.h"
#include "core/frames/board_finder.h"
#include "core/frames/flash_counts.h"

#include <optional>
#include <string>

namespace evical {

class FlashFinder {
 public:
  FlashFinder(const Board& board, Resolution size_px, const FrameOptions& frames,
              const BlinkOptions& options);

  // None where the board is not found. Whether the ink flashes or the paper is found out, and remembered.
  FoundPoints find(const FlashCounts& sum);
  // The points that lie within the gate of where a view nearby in time puts them; of a checkerboard, those that were found
  // last: nothing says whether there are others.
  FoundPoints measure(const FlashCounts& sum, const FoundPoints& near, double gate_px) const;

  std::string doubt() const { return finder_.doubt(); }

 private:
  FoundPoints onSensor(const GrayImage& picture, const GrayImage& larger, FoundPoints found) const;
  FoundPoints saddles(const GrayImage& picture, const GrayImage& larger, const FoundPoints& found) const;

  Board board_;
  Resolution size_px_;
  int times_;             // as large are the pictures that are searched
  FrameOptions options_;  // for these
  BoardFinder finder_;
  std::optional<Flashing> flashing_;
  FoundPoints last_found_;
};

}  // namespace evical
