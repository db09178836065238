// Surroundings of the corners of a board without circles.
#pragma once

#include "core/geometry/board.h"

#include <vector>

namespace evical {

// Around each corner, two diagonal fields are dark, and the other two are bright.
struct CornerPattern {
  double plain_m = 0.0;          // within this distance along both axes, the corner is the only feature
  std::vector<bool> dark_ahead;  // by point: true if the fields towards +x +y and -x -y are dark
};

// The square before point 0 of a checkerboard, towards -x -y, is dark.
CornerPattern checkerboardCorners(const Board& board);
CornerPattern tagGridCorners(const Board& board, int border_bits);
// The board's top left square is dark, unless `first_is_bright`.
CornerPattern charucoCorners(const Board& board, bool first_is_bright);

}  // namespace evical
