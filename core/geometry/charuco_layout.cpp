#include "core/geometry/charuco_layout.h"

namespace evical {

std::vector<BoardSquare> charucoMarkers(const Board& board, bool first_is_bright) {
  std::vector<BoardSquare> markers;
  for (int row = 0; row < board.rows; ++row)
    for (int col = 0; col < board.cols; ++col)
      if (((row + col) % 2 == 0) == first_is_bright) markers.push_back({row, col});
  return markers;
}

Eigen::Vector2d squareCorner_m(const Board& board, const BoardSquare& square) {
  return board.spacing_m * Eigen::Vector2d(square.col - 1, square.row - 1);
}

}  // namespace evical
