// Candidate place of a circle of the board: passed from candidate sources to the moving-circle fit.
#pragma once

#include <Eigen/Core>

namespace evical {

struct CircleCandidate {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // sensor pixels, at the window's middle
  double radius_px = 0.0;
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  // of motion, unit
  double speed_px_s = 0.0;                              // 0: unknown
  double score = 0.0;                                   // larger is better
};

}  // namespace evical
