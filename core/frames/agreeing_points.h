// Outlier rejection for points that a decoder read from a picture.
#pragma once

#include "core/frames/plane_map.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

struct ReadPoint {
  Eigen::Vector2d on_board_m = Eigen::Vector2d::Zero(), at_px = Eigen::Vector2d::Zero();
};

// The points that fit one plane within `tolerance_px`, which must allow for lens distortion; empty if fewer
// than half fit.
std::vector<ReadPoint> agreeingPoints(const std::vector<ReadPoint>& points, double tolerance_px);

// The map from points; empty if there are too few. `step_m` as for PlaneMap.
std::optional<PlaneMap> mapOf(const std::vector<ReadPoint>& points, double step_m);

}  // namespace evical
