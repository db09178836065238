// Curvature of the board's lines in a picture by a wide lens, from the points detected on them.
#pragma once

#include "core/frames/found_point.h"
#include "core/geometry/board.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

// Near a point, a line follows p = tangent s + normal curvature s^2 / 2.
struct BentLine {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double curvature_1_px = 0.0;
};

class BentLines {
 public:
  BentLines(const FoundPoints& found, const Board& board);

  // The lines along the board's rows and columns through the detected point of this index: a quadratic map of
  // the board's plane, fitted to the points around it. Empty if there are too few.
  std::optional<std::array<BentLine, 2>> through(std::size_t index) const;

 private:
  struct Neighbours {
    std::vector<Eigen::Vector2d> on_board_m, in_picture_px;  // the nearest first: the point itself
  };
  Neighbours around(std::size_t index) const;

  std::vector<Eigen::Vector2d> on_board_m_, in_picture_px_;
  double step_m_;
};

}  // namespace evical
