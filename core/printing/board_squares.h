// What is printed of boards without circles: rectangles, painted one over the other.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/marker_bits.h"

#include <string>
#include <vector>

namespace evical {

// What a board's numbers leave open.
struct TagPrint {
  int border_bits = 2;                  // of an AprilGrid's tags: Kalibr's 2, or 1
  std::string markers = kUsualMarkers;  // of a ChArUco board: ArUco's dictionary by its bits
};

struct PaintedBox {
  Eigen::Vector2d corner_m = Eigen::Vector2d::Zero(),
                  size_m = Eigen::Vector2d::Zero();  // in the board's frame
  bool bright = false;
};

// In the order of painting, on bright ground. Throws CalibrationError (BadInput) where the board needs more tags
// than there are, or a dictionary that there is not.
std::vector<PaintedBox> boardSquares(const Board& board, const TagPrint& print);

}  // namespace evical
