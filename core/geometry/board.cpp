#include "core/geometry/board.h"

#include "core/base/error.h"
#include "core/geometry/marker_bits.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

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

// Distance to the nearest other point.
double gap_m(const std::vector<Eigen::Vector2d>& points_m, std::size_t of) {
  double min_m2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points_m.size(); ++i)
    if (i != of) min_m2 = std::min(min_m2, (points_m[i] - points_m[of]).squaredNorm());
  return std::sqrt(min_m2);
}

// Ratio of the extents (one sigma) across and along the longest direction.
double roundness(const std::vector<Eigen::Vector2d>& points_m) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& each : points_m) mean += each / static_cast<double>(points_m.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& each : points_m) scatter += (each - mean) * (each - mean).transpose();
  const Eigen::Vector2d squares = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvalues();
  return std::sqrt(std::max(0.0, squares[0]) / squares[1]);
}

void validatePoints(const Board& board) {
  constexpr std::size_t kMin = 4;
  constexpr double kNarrowest = 0.01;  // a line does not determine a pose
  const std::vector<Eigen::Vector2d>& points_m = board.given_m;
  if (points_m.size() < kMin)
    throw badInput("board.points_m", std::to_string(points_m.size()) + " points are too few for a pose",
                   "Give at least 4 points, preferably dozens");
  std::set<std::pair<double, double>> taken;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    if (!points_m[i].allFinite())
      throw badInput("board.points_m", "point " + std::to_string(i) + " has no finite coordinates",
                     "Give x and y of each point, in metres");
    if (!taken.emplace(points_m[i].x(), points_m[i].y()).second)
      throw badInput("board.points_m",
                     "point " + std::to_string(i) + " has the same coordinates as another one",
                     "Remove or correct the duplicate");
  }
  if (!(roundness(points_m) > kNarrowest))
    throw badInput("board.points_m", "all points are on one line, which does not determine a pose",
                   "Add points away from this line");
}

}  // namespace

int Board::pointCount() const {
  switch (type) {
    case BoardType::AprilGrid:
      return kTagCorners * rows * cols;
    case BoardType::Charuco:
      return (rows - 1) * (cols - 1);
    case BoardType::Points:
      return static_cast<int>(given_m.size());
    default:
      return rows * cols;
  }
}

int Board::lineCount(bool of_rows) const {
  return (of_rows ? rows : cols) - (type == BoardType::Charuco ? 1 : 0);
}

int Board::lineOf(int index, bool of_rows) const {
  if (type == BoardType::AprilGrid) {
    const int tag = index / kTagCorners;
    return of_rows ? rows - 1 - tag / cols : tag % cols;
  }
  return of_rows ? index / pointsInRow() : index % pointsInRow();
}

Eigen::Vector2d Board::point_m(int row, int col) const {
  const int column_step = type == BoardType::AsymmetricCircles ? 2 * col + row % 2 : col;
  return {column_step * spacing_m, row * spacing_m};
}

Eigen::Vector2d Board::point_m(int index) const {
  if (type == BoardType::AprilGrid) return tagCorner_m(*this, index);
  if (type == BoardType::Points) return given_m.at(static_cast<std::size_t>(index));
  return point_m(index / pointsInRow(), index % pointsInRow());
}

Eigen::Vector2d Board::corner_m() const {
  Eigen::Vector2d least = Eigen::Vector2d::Zero();
  if (!given_m.empty()) least = given_m.front();
  for (const Eigen::Vector2d& each : given_m) least = least.cwiseMin(each);
  return least;
}

Eigen::Vector2d Board::extent_m() const {
  switch (type) {
    case BoardType::AprilGrid:
      return {(cols - 1) * spacing_m + tag_size_m, (rows - 1) * spacing_m + tag_size_m};
    case BoardType::Charuco:
      return {(cols - 2) * spacing_m, (rows - 2) * spacing_m};
    case BoardType::Points: {
      const Eigen::Vector2d least = corner_m();
      Eigen::Vector2d most = least;
      for (const Eigen::Vector2d& each : given_m) most = most.cwiseMax(each);
      return most - least;
    }
    default:
      return point_m(rows - 1, cols - 1)
          .cwiseMax(point_m(rows - 2, cols - 1));  // one of two staggered rows extends further
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

Board boardOfPoints(std::vector<Eigen::Vector2d> given_m) {
  Board board;
  board.type = BoardType::Points;
  board.rows = static_cast<int>(given_m.size());
  board.cols = 1;
  board.radius_m = 0.0;
  std::vector<double> gaps_m;
  for (std::size_t i = 0; i < given_m.size(); ++i) gaps_m.push_back(gap_m(given_m, i));
  const auto middle = gaps_m.begin() + static_cast<std::ptrdiff_t>(gaps_m.size() / 2);
  std::nth_element(gaps_m.begin(), middle, gaps_m.end());
  board.spacing_m = *middle;
  board.given_m = std::move(given_m);
  return board;
}

std::vector<Eigen::Vector2d> boardPoints_m(const Board& board) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(static_cast<std::size_t>(board.pointCount()));
  for (int i = 0; i < board.pointCount(); ++i) points.push_back(board.point_m(i));
  return points;
}

void validate(const Board& board) {
  if (!board.hasPattern()) return validatePoints(board);
  constexpr int kMaxRows = 100;
  const bool tags = board.type == BoardType::AprilGrid;
  const int least = tags ? 1 : board.type == BoardType::Charuco ? 3 : 2;
  if (board.rows < least || board.cols < least || board.rows > kMaxRows || board.cols > kMaxRows) {
    throw badInput(
        "board", "rows and cols must each be in " + std::to_string(least) + ".." + std::to_string(kMaxRows),
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
    throw badInput("board.radius_m", "applies to circles, which this board does not have", "Remove it");
  if (board.hasTags()) validateTags(board);
  if (board.first_tag != 0 && !tags)
    throw badInput("board.first_tag", "applies to AprilGrids only", "Remove it");
  const int end = board.first_tag + board.rows * board.cols;
  if (tags && (board.first_tag < 0 || end > kTagFamilySize))
    throw badInput("board.first_tag",
                   fmt::format("tags {} to {} are needed, but the family tag36h11 has 0 to {}",
                               board.first_tag, end - 1, kTagFamilySize - 1),
                   "Give the smallest number on the board, and the number of its rows and columns");
}

int maxSpacings(const Board& board) {
  return static_cast<int>(std::lround(board.extent_m().maxCoeff() / board.spacing_m));
}

void validate(const MeasuredLength& measured, const Board& board) {
  const int most = maxSpacings(board);
  if (measured.spacings < 1 || measured.spacings > most)
    throw badInput(
        "board.measured.spacings",
        fmt::format("{} spacings exceed this board's longest line, which has {}", measured.spacings, most),
        "Count the spacings from the first circle to the last: one less than the number of rows; in a line "
        "of a staggered board, two from circle to circle");
  if (!(measured.length_m > 0.0) || !std::isfinite(measured.length_m))
    throw badInput("board.measured.length_m", "must be greater than 0", "Measure it on the print, in metres");
  constexpr double kLargestShare = 0.1;  // a larger share means that metres and millimetres were confused
  if (!(measured.std_m >= 0.0) || measured.std_m > kLargestShare * measured.length_m)
    throw badInput("board.measured.std_m",
                   fmt::format("a sigma of {} m is not plausible for a length of {} m", measured.std_m,
                               measured.length_m),
                   "Give the sigma of a ruler reading in metres, for example 0.0005 for half a millimetre");
}

}  // namespace evical
