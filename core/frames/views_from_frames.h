// Conversion of points in frames to views of the board: velocities, covariances with motion, rejection of
// blurred views.
#pragma once

#include "core/frames/plane_map.h"

#include "core/data/board_observations.h"

#include <optional>
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

// Movement of a board between two pictures, and merging of views of a board at rest.

// RMS movement over the board's points; empty if the two have too few common points. Excludes noise of single
// points: only motion that a change of pose can cause counts.
std::optional<double> movement_px(const FoundPoints& from, const FoundPoints& to);

// The later view, with points numbered as in the earlier view at the same places: the numbering of a
// symmetric board, or of a part of a board, may change between views. Points that have moved further are
// removed.
FoundPoints numberedAs(const FoundPoints& earlier, const FoundPoints& later, double nearest_px);

// Replaces consecutive views in which the board moves by less than `still_px` by their mean. This reduces
// noise, but not errors of `common_sigma_px`.
std::vector<PointsInFrame> joinedWhileStill(const std::vector<PointsInFrame>& views, double still_px,
                                            double common_sigma_px);

}  // namespace evical
