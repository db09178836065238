// Finds the board in a picture, without knowledge of the lens and of other pictures.
//
// Corners are measured as crossing points of edges, circles as ellipses fitted to their edges. An ellipse's
// centre, in the sensor's own pixels, is what a lens without distortion would make of the circle
// (circle_conic.h); a lens bends the ellipse, which over a circle's few pixels is a matter of thousandths.
//
// Of checkerboards point 0 is the corner before which, towards -x -y, lies a dark square; where rows and columns
// are both even or both odd that holds of both ends or of none, and either may be point 0, as with symmetric
// circles.
#pragma once

#include "core/frames/found_point.h"
#include "core/frames/frame_options.h"
#include "core/frames/gray_image.h"
#include "core/frames/plane_map.h"
#include "core/geometry/board.h"

#include <memory>
#include <string>

namespace evical {

class PatternFinder;

// Of a checkerboard no part tells which part it is. Any will do where nothing but the lens is wanted: then its points
// are called those of the board's beginning.
enum class CheckerboardParts { None, Any };

class BoardFinder {
 public:
  // Throws CalibrationError (BadInput) where the board's numbers make no board.
  BoardFinder(const Board& board, const FrameOptions& options,
              CheckerboardParts parts = CheckerboardParts::None);
  ~BoardFinder();
  BoardFinder(BoardFinder&&) noexcept;
  BoardFinder& operator=(BoardFinder&&) noexcept;

  // Points that are seen, all or a part of them; none where the board is not found. Remembers what of a board
  // it need not try again: the tags' border, the markers' dictionary.
  FoundPoints find(const GrayImage& image);

  // Points near where the map puts them: a search that takes a hundredth of the time.
  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const;

  // What speaks against the board's numbers, in a sentence; empty where nothing does.
  std::string doubt() const;

 private:
  std::unique_ptr<PatternFinder> finder_;
};

}  // namespace evical
