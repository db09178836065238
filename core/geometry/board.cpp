#include "core/geometry/board.h"

#include "core/base/error.h"

#include <array>
#include <cmath>

namespace evical {
namespace {

constexpr int kTagCorners = 4;

Eigen::Vector2d tagCorner_m(const Board& board, int index) {
  static const std::array<Eigen::Vector2d, kTagCorners> kPlaces = {
      Eigen::Vector2d{0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}};
  const int tag = index / kTagCorners, row = board.rows - 1 - tag / board.cols;
  return board.spacing_m * Eigen::Vector2d(tag % board.cols, row) +
         board.tag_size_m * kPlaces.at(static_cast<std::size_t>(index % kTagCorners));
}

void validateCircles(const Board& board) {
  const double nearest_m =
      board.type == BoardType::AsymmetricCircles ? std::sqrt(2.0) * board.spacing_m : board.spacing_m;
  if (board.radius_m > 0.0 && board.radius_m < 0.5 * nearest_m) return;
  throw badInput("board.radius_m", "must be greater than 0 and less than half the distance between circles",
                 "Measure a circle's diameter on the print and give half of it, in metres");
}

void validateTags(const Board& board) {
  if (board.tag_size_m > 0.0 && board.tag_size_m < board.spacing_m) return;
  throw badInput("board.tag_size_m",
                 board.type == BoardType::AprilGrid
                     ? "must be greater than 0 and less than the distance from one tag to the next"
                     : "must be greater than 0 and less than a square's edge",
                 "Measure the black edge of a tag on the print, in metres");
}

}  // namespace

int Board::pointCount() const {
  switch (type) {
    case BoardType::AprilGrid:
      return kTagCorners * rows * cols;
    case BoardType::Charuco:
      return (rows - 1) * (cols - 1);
    default:
      return rows * cols;
  }
}

Eigen::Vector2d Board::point_m(int row, int col) const {
  const int column_step = type == BoardType::AsymmetricCircles ? 2 * col + row % 2 : col;
  return {column_step * spacing_m, row * spacing_m};
}

Eigen::Vector2d Board::point_m(int index) const {
  if (type == BoardType::AprilGrid) return tagCorner_m(*this, index);
  return point_m(index / pointsInRow(), index % pointsInRow());
}

Eigen::Vector2d Board::extent_m() const {
  switch (type) {
    case BoardType::AprilGrid:
      return {(cols - 1) * spacing_m + tag_size_m, (rows - 1) * spacing_m + tag_size_m};
    case BoardType::Charuco:
      return {(cols - 2) * spacing_m, (rows - 2) * spacing_m};
    default:
      return point_m(rows - 1, cols - 1)
          .cwiseMax(point_m(rows - 2, cols - 1));  // of staggered rows one ends later
  }
}

double Board::printBeyond_m() const {
  if (hasCircles()) return radius_m;
  return type == BoardType::AprilGrid ? spacing_m - tag_size_m : spacing_m;
}

bool Board::hasHalfTurnAmbiguity() const {
  switch (type) {
    case BoardType::SymmetricCircles:
      return true;
    case BoardType::AsymmetricCircles:
      return rows % 2 == 0;
    case BoardType::Checkerboard:
      return rows % 2 == cols % 2;
    default:
      return false;
  }
}

std::vector<Eigen::Vector2d> boardPoints_m(const Board& board) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(static_cast<std::size_t>(board.pointCount()));
  for (int i = 0; i < board.pointCount(); ++i) points.push_back(board.point_m(i));
  return points;
}

void validate(const Board& board) {
  constexpr int kMostRows = 100;
  const bool tags = board.type == BoardType::AprilGrid;
  const int least = tags ? 1 : board.type == BoardType::Charuco ? 3 : 2;
  if (board.rows < least || board.cols < least || board.rows > kMostRows || board.cols > kMostRows) {
    throw badInput(
        "board", "rows and cols must each lie in " + std::to_string(least) + ".." + std::to_string(kMostRows),
        board.hasCircles() ? "Count the circles: an asymmetric board's rows are the staggered lines"
                           : (tags ? "Count the tags"
                                   : "Count a checkerboard's inner corners, a ChArUco board's "
                                     "squares"));
  }
  if (!(board.spacing_m > 0.0) || !std::isfinite(board.spacing_m)) {
    throw badInput("board.spacing_m", "must be greater than 0", "Measure it on the print, in metres");
  }
  if (board.hasCircles()) validateCircles(board);
  if (!board.hasCircles() && board.radius_m != 0.0)
    throw badInput("board.radius_m", "is of circles, and this board has none", "Remove it");
  if (board.hasTags()) validateTags(board);
}

}  // namespace evical
