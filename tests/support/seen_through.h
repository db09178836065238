// Circles of one lens as reported by a front end that uses another.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/camera_model.h"

#include <Eigen/LU>

namespace evical::test {

// From the ideal pixels of `truth` to those of `lens`; small shapes change like their position.
inline void seeThrough(const CameraIntrinsics& truth, const CameraIntrinsics& lens,
                       BoardObservations& observations) {
  for (BoardView& view : observations.views) {
    for (CircleObservation& circle : view.circles) {
      const Eigen::Vector2d seen_px = idealPixel(lens, pixelFromIdeal(truth, circle.centre_px)).value();
      const Eigen::Matrix2d change =
          idealPixelScale(lens, seen_px) * idealPixelScale(truth, circle.centre_px).inverse();
      circle.centre_px = seen_px;
      circle.covariance_px2 = (change * circle.covariance_px2 * change.transpose()).eval();
      circle.velocity_px_s = (change * circle.velocity_px_s).eval();
      circle.edge_localisation_bias_effect = (change * circle.edge_localisation_bias_effect).eval();
    }
  }
}

}  // namespace evical::test
