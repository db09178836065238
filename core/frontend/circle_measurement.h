// One circle of a fitted board, measured by its own bursts alone: what the estimator uses.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/board_motion.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

// Bursts of a measurement: those no further than half_s from the window's middle. Slots of neighbouring
// windows do not overlap, so no burst serves two measurements. Times are in seconds since start_ns.
struct MeasuredSlot {
  double half_s = 0.0;
  std::int64_t start_ns = 0;
};

// Why a circle of the board has a centre in a window, or has none.
enum class CircleVerdict {
  Measured,
  OutsideImage,   // not wholly inside, at least
  TooFewBursts,   // around its edge
  TooFewInliers,  // among the bursts around its edge
  TooShortArc,    // its bursts cover too little of its outline
  OffTheBoard,    // too far from where the board's fit has it
  TooUnsure,      // of its centre
};
const char* circleVerdictName(CircleVerdict verdict);  // in plain words

// A burst that a measured centre was fitted to.
struct EdgeInlier {
  Eigen::Vector2f pixel;
  bool leading;
};

// Further data of a measurement of all circles; for drawings.
struct MeasurementTrace {
  std::vector<CircleVerdict> verdicts;  // by circle of the board
  std::vector<EdgeInlier> inliers;
};

// Fits each circle's centre (and radius offset, with a prior at the board's) to the slot's bursts. Velocities
// come from the board's field. Circles with another verdict than Measured are excluded. The trace is filled
// if it is not null.
std::vector<CircleObservation> measureCircles(const BurstWindow& window, const BoardMotion& motion,
                                              const BoardScene& scene, const MeasuredSlot& slot,
                                              const TrackingOptions& options,
                                              MeasurementTrace* trace = nullptr);

}  // namespace evical
