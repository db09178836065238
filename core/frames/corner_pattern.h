// What surrounds the corners of a board without circles.
#pragma once

#include "core/geometry/board.h"

#include <vector>

namespace evical {

// Around each corner two fields are dark, those on one diagonal, and two are bright.
struct CornerPattern {
  double plain_m = 0.0;          // within this distance along both axes there is nothing but the corner
  std::vector<bool> dark_ahead;  // by point: dark are the fields towards +x +y and -x -y
};

// Of a checkerboard the square before point 0, towards -x -y, is dark.
CornerPattern checkerboardCorners(const Board& board);
CornerPattern tagGridCorners(const Board& board, int border_bits);
// The board's top left square is dark, unless `first_is_bright`.
CornerPattern charucoCorners(const Board& board, bool first_is_bright);

}  // namespace evical
