// One circle of a fitted board, measured by its own bursts alone: what the estimator uses.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/board_motion.h"

#include <optional>
#include <vector>

namespace evical {

// Fits each circle's centre (and radius offset, held near the board's) to the bursts no further than
// half_slot_s from the window's middle. Slots of neighbouring windows do not overlap, so no burst serves two
// measurements. Velocities come from the board's field. times are seconds since start_ns. Circles that have
// too few bursts, see too little of their arc, or lie too far from the board's fit are left out.
std::vector<CircleObservation> measureCircles(const BurstWindow& window, const BoardMotion& motion,
                                              const BoardScene& scene, double half_slot_s,
                                              std::int64_t start_ns, const TrackingOptions& options);

}  // namespace evical
