// Views of a perfect front end, and noisy observations derived from them without events.
#pragma once

#include "core/data/board_observations.h"
#include "core/synthetic/sinusoid_motion.h"

#include <optional>
#include <vector>

namespace evical {

// The true image of one circle.
struct TrueCircle {
  int circle = 0;
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();      // of the ellipse, ideal pixels
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();  // ideal pixels
  bool inside = false;                                      // the whole circle is in the image
  bool hidden = false;                                      // a hand covers some of it

  bool isVisible() const { return inside && !hidden; }
};

// All circles in front of the camera, at a time of the camera's *stamps*: the delay of pixels and the clocks'
// offset are removed, so detections can be compared directly. Seconds since scenario.start_ns.
std::vector<TrueCircle> trueBoardView(const SinusoidMotion& motion, const Scenario& scenario,
                                      std::size_t camera, double stamp_s);

// Circles that are completely in the image and not hidden; and whether they suffice for a partial grid
// (docs/maths.md, 5.4), here at least 4 and 40 %.
int circlesInView(const SinusoidMotion& motion, const Scenario& scenario, std::size_t camera, double stamp_s);
bool boardInView(const SinusoidMotion& motion, const Scenario& scenario, std::size_t camera, double stamp_s);

// Truth with Gaussian noise of `noise_px` per axis, every `period_s`, visible circles only.
BoardObservations simulateObservations(const Scenario& scenario, std::size_t camera, double noise_px,
                                       double period_s);

}  // namespace evical
