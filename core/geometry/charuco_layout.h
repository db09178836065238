// Places of a ChArUco board's markers: in its bright squares, numbered row by row from the top left.
#pragma once

#include "core/geometry/board.h"

#include <vector>

namespace evical {

struct BoardSquare {
  int row = 0, col = 0;
};

// By number. The top left square is dark, unless `first_is_bright`: OpenCV before 4.6 drew boards with an
// even number of rows in this way, which it calls legacy.
std::vector<BoardSquare> charucoMarkers(const Board& board, bool first_is_bright);

// Top left corner of a square, in the board's frame, whose origin is the first inner corner.
Eigen::Vector2d squareCorner_m(const Board& board, const BoardSquare& square);

}  // namespace evical
