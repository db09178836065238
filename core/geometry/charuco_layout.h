// Places of a ChArUco board's markers: in its bright squares, numbered row by row from the top left.
#pragma once

#include "core/geometry/board.h"

#include <vector>

namespace evical {

struct BoardSquare {
  int row = 0, col = 0;
};

// By number. The top left square is dark, unless `first_is_bright`: boards with an even number of rows that
// OpenCV before 4.6 drew, which calls them legacy.
std::vector<BoardSquare> charucoMarkers(const Board& board, bool first_is_bright);

// A square's top left corner, in the board's frame, whose origin is the first inner corner.
Eigen::Vector2d squareCorner_m(const Board& board, const BoardSquare& square);

}  // namespace evical
