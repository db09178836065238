// Displacement of measured tag corners away from the middle of their tag. Detectors of tags measure corners
// inwards by tenths of a pixel, in all views alike: a calibration takes this for another lens or board.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/calibration_result.h"

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

struct TagCornerShift {
  double outwards_px = 0.0;  // corrects the measured corners
  double sigma_px = 0.0;     // from the scatter of the views' means
};

// Estimate from the residuals (predicted - measured) of one camera, whose board is an AprilGrid; in order of
// view and corner. 0 with fewer than two views of whole tags.
TagCornerShift tagCornerShift(std::size_t camera, std::span<const CircleResidual> residuals);

// Moves all corners away from the middle of their tag; those of tags with fewer than four corners stay.
void moveTagCorners(double outwards_px, std::vector<BoardView>& views);

}  // namespace evical
