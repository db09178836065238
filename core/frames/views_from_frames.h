// From points in frames to views of the board: velocities, what motion adds to covariances, what is too blurred.
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

// A view for each frame. Velocities are differences to the frames before and after, where those are near enough
// in time, and 0 where there is none. While a frame is exposed a point moves by velocity times exposure: a tenth
// of that, along the motion, is taken for the error it leaves.
std::vector<ViewFromFrame> viewsFromFrames(const std::vector<PointsInFrame>& frames, int points_of_board);

}  // namespace evical
