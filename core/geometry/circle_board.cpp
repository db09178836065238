#include "core/geometry/circle_board.h"

#include "core/base/error.h"

#include <cmath>

namespace evical {

Eigen::Vector2d CircleBoard::centre_m(int row, int col) const {
  const int column_step = type == BoardType::AsymmetricCircles ? 2 * col + row % 2 : col;
  return {column_step * spacing_m, row * spacing_m};
}

Eigen::Vector2d CircleBoard::extent_m() const {
  return centre_m(rows - 1, cols - 1)
      .cwiseMax(centre_m(rows - 2, cols - 1));  // of staggered rows one ends later
}

bool CircleBoard::hasHalfTurnAmbiguity() const {
  return type == BoardType::SymmetricCircles || rows % 2 == 0;
}

std::vector<Eigen::Vector2d> circleCentres_m(const CircleBoard& board) {
  std::vector<Eigen::Vector2d> centres;
  centres.reserve(static_cast<std::size_t>(board.circleCount()));
  for (int i = 0; i < board.circleCount(); ++i) centres.push_back(board.centre_m(i));
  return centres;
}

void validate(const CircleBoard& board) {
  constexpr int kMostRows = 100;
  if (board.rows < 2 || board.cols < 2 || board.rows > kMostRows || board.cols > kMostRows) {
    throw badInput("board", "rows and cols must each lie in 2..100",
                   "Count the circles: an asymmetric board's rows are the staggered lines");
  }
  if (!(board.spacing_m > 0.0) || !std::isfinite(board.spacing_m)) {
    throw badInput("board.spacing_m", "must be greater than 0", "Measure it on the print, in metres");
  }
  const double nearest_m =
      board.type == BoardType::AsymmetricCircles ? std::sqrt(2.0) * board.spacing_m : board.spacing_m;
  if (!(board.radius_m > 0.0) || board.radius_m >= 0.5 * nearest_m) {
    throw badInput("board.radius_m", "must be greater than 0 and less than half the distance between circles",
                   "Measure a circle's diameter on the print and give half of it, in metres");
  }
}

}  // namespace evical
