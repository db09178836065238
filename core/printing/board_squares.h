// Rectangles of boards without circles, painted one over the other.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/marker_bits.h"

#include <string>
#include <vector>

namespace evical {

// Properties of printed tags that the board's dimensions do not determine.
struct TagPrint {
  int border_bits = 2;                  // AprilGrid: 2 as in Kalibr, or 1
  std::string markers = kUsualMarkers;  // ChArUco board: name of ArUco's dictionary
};

struct PaintedBox {
  Eigen::Vector2d corner_m = Eigen::Vector2d::Zero(),
                  size_m = Eigen::Vector2d::Zero();  // in the board's frame
  bool bright = false;
};

// In painting order, on a bright background. Throws CalibrationError (BadInput) if the board needs more tags
// than the dictionary has, or if the dictionary is unknown.
std::vector<PaintedBox> boardSquares(const Board& board, const TagPrint& print);

}  // namespace evical
