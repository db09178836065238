// Corners of squares in the events of a window: where four dark and bright fields meet, brightness has a
// saddle. Each edge crossing is moved along its normal to the window's middle and votes for the corners on
// the line along it. A vote is the angle of the way from the corner to the crossing plus that of the
// gradient: at a saddle, all four edges have the same sum (docs/maths.md, 5.8).
#pragma once

#include "core/frontend/burst_window.h"
#include "core/frontend/detection_options.h"

#include <Eigen/Core>

#include <cmath>
#include <numbers>
#include <vector>

namespace evical {

// An edge at the window's middle, in sensor pixels.
struct MovedCrossing {
  Eigen::Vector2f at_px;
  Eigen::Vector2f to_bright;      // unit
  Eigen::Vector2f velocity_px_s;  // along the normal
};
std::vector<MovedCrossing> crossingsAtMiddle(const BurstWindow& window, const NormalFlowOptions& options);

// An angle within half a turn of 0.
inline double wrapped_rad(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

struct SaddleCandidate {
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
  double phase_rad = 0.0;  // angle of the votes: 2 a - 90 degrees if the quadrant between the lines at a and
                           // a + 90 degrees is dark
  double score = 0.0;      // sum of the votes
};

// Best first. `reach_px`: the largest distance of a vote.
std::vector<SaddleCandidate> voteForSaddles(const std::vector<MovedCrossing>& crossings,
                                            Resolution resolution_px, double reach_px,
                                            const SaddleOptions& options);

}  // namespace evical
