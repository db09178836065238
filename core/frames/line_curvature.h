// How much the board's lines bend in a picture by a wide lens, told by the points that were found on them.
#pragma once

#include "core/frames/found_point.h"
#include "core/geometry/board.h"

#include <array>
#include <optional>
#include <vector>

namespace evical {

// Near a point a line runs along p = tangent s + normal curvature s^2 / 2.
struct BentLine {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double curvature_1_px = 0.0;
};

// The lines through a point along the board's rows and columns: a quadratic map of the board's plane, fitted to the
// points found around it. Nothing where they are too few.
std::optional<std::array<BentLine, 2>> linesThrough(int point, const FoundPoints& found, const Board& board);

}  // namespace evical
