// The printed target: a grid of circles. Board (= world) frame: origin at the first circle's centre, x along
// a row, y down the columns, z into the board; metres.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace evical {

enum class BoardType { AsymmetricCircles, SymmetricCircles };
enum class CircleShade { Dark, Bright };  // dark circles on a bright board, or the inverse

struct CircleBoard {
  BoardType type = BoardType::AsymmetricCircles;
  int rows = 11;
  int cols = 4;
  double spacing_m = 0.05;  // asymmetric: between two rows, and half the distance within a row
  double radius_m = 0.02;
  CircleShade circles = CircleShade::Dark;

  bool operator==(const CircleBoard&) const = default;

  int circleCount() const { return rows * cols; }
  int index(int row, int col) const { return row * cols + col; }

  // Asymmetric: ((2 col + row mod 2) s, row s); symmetric: (col s, row s).
  Eigen::Vector2d centre_m(int row, int col) const;
  Eigen::Vector2d centre_m(int circle_index) const {
    return centre_m(circle_index / cols, circle_index % cols);
  }

  // Between the outermost centres.
  Eigen::Vector2d extent_m() const;

  // True if the pattern turned by 180 degrees is the same pattern: every symmetric board, and an asymmetric
  // one with an even number of rows. Such a board does for intrinsics only.
  bool hasHalfTurnAmbiguity() const;
};

// All centres, by circle index.
std::vector<Eigen::Vector2d> circleCentres_m(const CircleBoard& board);

// Throws CalibrationError (BadInput, place "board") when the numbers make no board: fewer than 2 rows or
// columns, more than 100 of either, no size, circles that touch.
void validate(const CircleBoard& board);

}  // namespace evical
