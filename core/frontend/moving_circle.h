// A circle with constant velocity in a window, fitted to burst medians (docs/maths.md, 5.3):
// accurate enough for the board's lattice; the joint fit of the board models the ellipses.
#pragma once

#include "core/frontend/burst_window.h"
#include "core/frontend/circle_candidate.h"
#include "core/frontend/detection_options.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

struct MovingCircle {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // sensor pixels, at the window's middle
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
  double radius_px = 0.0;
  double rms_px = 0.0;
  int bursts = 0;
  int sectors = 0;  // of 16
};

// Typical speed of edges in the window, from planes through neighbouring bursts' times; 0
// if there are too few.
double typicalEdgeSpeed_px_s(const BurstWindow& window);

// If the candidate has no speed, several multiples of `speed_px_s` > 0 are tried.
std::optional<MovingCircle> fitMovingCircle(const BurstWindow& window, const CircleCandidate& candidate,
                                            double speed_px_s, const MovingCircleOptions& options);

// Fits of all candidates; the better one of overlapping circles is kept. Best first.
std::vector<MovingCircle> fitMovingCircles(const BurstWindow& window,
                                           const std::vector<CircleCandidate>& candidates, double speed_px_s,
                                           const MovingCircleOptions& options);

}  // namespace evical
