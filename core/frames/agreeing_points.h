// Points that a decoder read off a picture, of which some may be false.
#pragma once

#include "core/frames/plane_map.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

struct ReadPoint {
  Eigen::Vector2d on_board_m = Eigen::Vector2d::Zero(), at_px = Eigen::Vector2d::Zero();
};

// Those that one plane explains within `tolerance_px`, which must leave room for what a lens bends; none where
// fewer than half do.
std::vector<ReadPoint> agreeingPoints(const std::vector<ReadPoint>& points, double tolerance_px);

// The map that points make; nothing where they are too few. `step_m` as PlaneMap has it.
std::optional<PlaneMap> mapOf(const std::vector<ReadPoint>& points, double step_m);

}  // namespace evical
