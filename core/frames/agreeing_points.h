// Points that a decoder read off a picture, of which some may be false.
#pragma once

#include "core/frames/found_point.h"
#include "core/geometry/board.h"

#include <vector>

namespace evical {

struct ReadPoint {
  Eigen::Vector2d on_board_m = Eigen::Vector2d::Zero(), at_px = Eigen::Vector2d::Zero();
};

// Those that one plane explains within `tolerance_px`, which must leave room for what a lens bends; none where
// fewer than half do.
std::vector<ReadPoint> agreeingPoints(const std::vector<ReadPoint>& points, double tolerance_px);

}  // namespace evical
