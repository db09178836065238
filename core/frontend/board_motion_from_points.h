// A board's motion from a few of its points, if no better estimate is available: for the circles of a search,
// or the centres of an earlier view.
#pragma once

#include "core/frontend/board_motion.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace evical {

// In ideal pixels.
struct MovingPoint {
  Eigen::Vector2d centre_px, velocity_px_s;
};

// The plane flow that fits the velocities; terms that a few points do not determine are regularised towards
// zero.
PlaneFlow fitPlaneFlow(const ImageFrame& frame, const std::vector<MovingPoint>& points);

// The homography, with a frame around the points and their flow.
BoardMotion motionFromPoints(const Eigen::Matrix3d& ideal_from_board, const std::vector<MovingPoint>& points,
                             std::int64_t time_ns);

}  // namespace evical
