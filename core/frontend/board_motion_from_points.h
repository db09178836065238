// A board's motion from a few of its points, if nothing better is available: when a search has circles, or
// when only the centres of an earlier view are left.
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

// The plane flow that the velocities agree on; terms that a few points do not show are drawn towards zero.
PlaneFlow fitPlaneFlow(const ImageFrame& frame, const std::vector<MovingPoint>& points);

// The homography, with a frame around the points and their flow.
BoardMotion motionFromPoints(const Eigen::Matrix3d& ideal_from_board, const std::vector<MovingPoint>& points,
                             std::int64_t time_ns);

}  // namespace evical
