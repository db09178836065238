// Measurement of one circle of a fitted board from its own bursts: the input of the estimator.
#pragma once

#include "core/frontend/board_motion.h"

#include "core/data/board_observations.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace evical {

// Bursts of a measurement: those within half_s of the window's middle. Slots of neighbouring
// windows do not overlap, so no burst is used in two measurements. Times are in seconds since start_ns.
struct MeasuredSlot {
  double half_s = 0.0;
  std::int64_t start_ns = 0;
};

// Why a circle of the board has or does not have a centre in a window.
enum class CircleVerdict {
  Measured,
  OutsideImage,   // at least partly
  TooFewBursts,   // around its edge
  TooFewInliers,  // among the bursts around its edge
  TooShortArc,    // its bursts cover too little of its outline
  OffTheBoard,    // too far from its place in the board's fit
  TooUnsure,      // sigma of the centre too large
};
const char* circleVerdictName(CircleVerdict verdict);  // for display

// A burst in the fit of a centre.
struct EdgeInlier {
  Eigen::Vector2f pixel;
  bool leading;
};

// Further data of the measurement of all circles; for drawings.
struct MeasurementTrace {
  std::vector<CircleVerdict> verdicts;  // by circle of the board
  std::vector<EdgeInlier> inliers;
};

// Fits each circle's centre (and radius offset, with the board's as prior) to the slot's bursts. Velocities
// are from the board's field. Circles with another verdict than Measured are excluded. Fills the trace if it
// is not null.
std::vector<CircleObservation> measureCircles(const BurstWindow& window, const BoardMotion& motion,
                                              const BoardScene& scene, const MeasuredSlot& slot,
                                              const TrackingOptions& options,
                                              MeasurementTrace* trace = nullptr);

}  // namespace evical
