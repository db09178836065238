// Errors of edges that repeat whenever an edge crosses the same pixel again: no residual shows them and
// no number of views averages them. Circles that cross few pixels show a wrong amplitude by them: a
// change in proportion to the centre's distance from its mean place, of pixel_error / a^1.5 with a the
// RMS of these distances in pixels, as many independent errors as pixels. Not estimated, only allowed
// for in the reported sigmas.
#pragma once

#include "core/data/calibration_setup.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

class PixelErrors {
 public:
  PixelErrors(const CameraData& camera, const Board& board, double pixel_error_px);

  // Change of the circle's centre by one sigma; ideal pixels.
  Eigen::Vector2d at(const CircleObservation& circle) const;

 private:
  std::vector<Eigen::Vector2d> mean_px_;  // by circle of the board
  double swing_ = 0.0;                    // relative
};

}  // namespace evical
