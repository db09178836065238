// Conversion of points in frames to views of the board: velocities, covariances with motion, rejection of
// blurred views.
#pragma once

#include "core/data/board_observations.h"
#include "core/frames/found_point.h"

#include <vector>

namespace evical {

struct PointsInFrame {
  double time_s = 0.0, exposure_s = 0.0;
  FoundPoints points;
};

struct ViewFromFrame {
  BoardView view;
  double speed_px_s = 0.0;  // median of its points
};

// One view per frame. Velocities are differences to the frames before and after, if these are close enough
// in time, else 0. During the exposure a point moves by velocity times exposure: a tenth
// of that, along the motion, is added as an error.
std::vector<ViewFromFrame> viewsFromFrames(const std::vector<PointsInFrame>& frames, int points_of_board);

}  // namespace evical
