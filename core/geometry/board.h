// The printed target: a grid of circles, a checkerboard, or a grid of tags. Its points are what cameras
// measure: centres of circles, or corners, which are circles of radius 0. Board (= world) frame: x along a row,
// y down the columns, z into the board; metres. Its origin is the first circle's centre, the checkerboard's
// first inner corner, or the top left corner of the AprilGrid's top left tag.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace evical {

enum class BoardType { AsymmetricCircles, SymmetricCircles, Checkerboard, AprilGrid, Charuco };
// As sessions write them, in the enumeration's order.
inline constexpr std::array kBoardTypeNames = {"asymmetric_circles", "symmetric_circles", "checkerboard",
                                               "aprilgrid", "charuco"};
static_assert(kBoardTypeNames.size() == static_cast<std::size_t>(BoardType::Charuco) + 1);
constexpr const char* boardTypeName(BoardType type) {
  return kBoardTypeNames[static_cast<std::size_t>(type)];
}

enum class CircleShade { Dark, Bright };  // dark circles on a bright board, or the inverse

struct Board {
  BoardType type = BoardType::AsymmetricCircles;
  // Of circles; of a checkerboard's inner corners; of an AprilGrid's tags; of a ChArUco board's squares.
  int rows = 11;
  int cols = 4;
  // Circles: between two rows (asymmetric: that is half the distance within a row); a square's edge; from one
  // tag to the next.
  double spacing_m = 0.05;
  double radius_m = 0.02;  // of circles; 0: the points are corners
  CircleShade circles = CircleShade::Dark;
  double tag_size_m = 0.0;  // edge of a tag's black square: AprilGrid, ChArUco

  bool operator==(const Board&) const = default;

  bool hasCircles() const {
    return type == BoardType::AsymmetricCircles || type == BoardType::SymmetricCircles;
  }

  bool hasTags() const { return type == BoardType::AprilGrid || type == BoardType::Charuco; }

  int pointCount() const;
  // Of circles and of corners between squares; tags' corners have no such place.
  int index(int row, int col) const { return row * pointsInRow() + col; }
  int pointsInRow() const { return type == BoardType::Charuco ? cols - 1 : cols; }

  // Asymmetric circles: ((2 col + row mod 2) s, row s); symmetric ones and corners between squares: (col s, row s).
  Eigen::Vector2d point_m(int row, int col) const;
  // Circles and corners row by row. Of an AprilGrid four a tag, as Kalibr counts them: tags row by row from the
  // bottom left, corners from the bottom left against the clock.
  Eigen::Vector2d point_m(int index) const;

  // Between the outermost points, and how far the print reaches beyond them.
  Eigen::Vector2d extent_m() const;
  double printBeyond_m() const;

  // True if the pattern turned by 180 degrees is the same pattern: symmetric circles, asymmetric ones with an
  // even number of rows, checkerboards whose rows and columns are both even or both odd. Such a board does for
  // intrinsics only.
  bool hasHalfTurnAmbiguity() const;
};

// All points, by index.
std::vector<Eigen::Vector2d> boardPoints_m(const Board& board);

// Throws CalibrationError (BadInput, place "board") when the numbers make no board: fewer than 2 rows or
// columns (of tags: than 1), more than 100 of either, no size, circles or tags that touch.
void validate(const Board& board);

}  // namespace evical
