// The printed target: a grid of circles, a checkerboard, a grid of tags, or any points with given places. Its
// points are what cameras measure: centres of circles, or corners, which are circles of radius 0. Board (=
// world) frame: x along a row, y down the columns, z into the board; metres. Its origin is the first circle's
// centre, the checkerboard's first inner corner, the top left corner of the AprilGrid's top left tag, or that
// of the given places.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace evical {

enum class BoardType { AsymmetricCircles, SymmetricCircles, Checkerboard, AprilGrid, Charuco, Points };
// Names in session files, in the enumeration's order.
inline constexpr std::array kBoardTypeNames = {"asymmetric_circles", "symmetric_circles", "checkerboard",
                                               "aprilgrid",          "charuco",           "points"};
static_assert(kBoardTypeNames.size() == static_cast<std::size_t>(BoardType::Points) + 1);
// All types except the last have a pattern, which can be drawn, printed and detected.
inline constexpr std::span<const char* const> kPatternNames(kBoardTypeNames.data(),
                                                            kBoardTypeNames.size() - 1);
constexpr const char* boardTypeName(BoardType type) {
  return kBoardTypeNames[static_cast<std::size_t>(type)];
}

enum class CircleShade { Dark, Bright };  // dark circles on a bright board, or the inverse

struct Board {
  BoardType type = BoardType::AsymmetricCircles;
  // Number of circles; of inner corners of a checkerboard; of tags of an AprilGrid; of squares of a ChArUco
  // board. Given points: as many rows as points, with one point each.
  int rows = 11;
  int cols = 4;
  // Circles: distance between two rows (asymmetric: half the distance within a row). Squares: their edge.
  // Tags: distance from one to the next. Given points: typical distance of neighbours.
  double spacing_m = 0.05;
  double radius_m = 0.02;  // of circles; 0: the points are corners
  CircleShade circles = CircleShade::Dark;
  double tag_size_m = 0.0;               // edge of a tag's black square: AprilGrid, ChArUco
  std::vector<Eigen::Vector2d> given_m;  // type Points only, by index
  int first_tag = 0;                     // number of an AprilGrid's first tag; the others follow

  bool operator==(const Board&) const = default;

  bool hasCircles() const {
    return type == BoardType::AsymmetricCircles || type == BoardType::SymmetricCircles;
  }

  bool hasTags() const { return type == BoardType::AprilGrid || type == BoardType::Charuco; }

  bool hasPattern() const { return type != BoardType::Points; }

  int pointCount() const;
  // Index of circles and of corners between squares; tags' corners do not have one.
  int index(int row, int col) const { return row * pointsInRow() + col; }
  int pointsInRow() const { return type == BoardType::Charuco ? cols - 1 : cols; }

  // Lines of points, or of tags, whose number a session states: rows and cols, or of a ChArUco board one
  // less.
  int lineCount(bool of_rows) const;
  // The one that a point is on.
  int lineOf(int index, bool of_rows) const;

  // Asymmetric circles: ((2 col + row mod 2) s, row s); symmetric ones and corners between squares: (col s,
  // row s).
  Eigen::Vector2d point_m(int row, int col) const;
  // Circles and corners row by row. AprilGrid: four per tag, as Kalibr counts them: tags row by row from the
  // bottom left, corners counterclockwise from the bottom left.
  Eigen::Vector2d point_m(int index) const;

  // The corner with the smallest x and y; the opposite corner relative to it; and the margin of the print
  // around the points.
  Eigen::Vector2d corner_m() const;
  Eigen::Vector2d extent_m() const;
  double printBeyond_m() const;

  // True if the pattern is unchanged by a rotation of 180 degrees: symmetric circles, asymmetric ones with an
  // even number of rows, checkerboards whose rows and columns are both even or both odd. Use such a board for
  // intrinsics only.
  bool hasHalfTurnAmbiguity() const;
};

// Board of given flat points, at least one.
Board boardOfPoints(std::vector<Eigen::Vector2d> given_m);

// All points, by index.
std::vector<Eigen::Vector2d> boardPoints_m(const Board& board);

// Throws CalibrationError (BadInput, place "board") if the numbers are invalid: fewer than 2 rows or columns
// (tags: fewer than 1), more than 100 of either, no size, circles or tags that touch; given points that are
// fewer than four, on a line, or coincident.
void validate(const Board& board);

// A length measured on the board with a ruler, from one circle's centre to another in the same line.
struct MeasuredLength {
  int spacings = 10;  // between the circles: 10 from the first of 11 rows to the last
  double length_m = 0.5;
  double std_m = 0.0005;  // of the ruler reading; 0: exact

  bool operator==(const MeasuredLength&) const = default;

  double spacing_m() const { return length_m / spacings; }
  double relativeStd() const { return std_m / length_m; }
};

// Number of spacings in the board's longest line.
int maxSpacings(const Board& board);

// Throws CalibrationError (BadInput, place "board.measured...") if the board has no such line, or a value is
// implausible.
void validate(const MeasuredLength& measured, const Board& board);

}  // namespace evical
