// Does the lattice of circles end where the board does? A session may give too few or too many rows or
// columns, and the board is found all the same.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/board_motion.h"
#include "core/frontend/front_end_options.h"

#include <vector>

namespace evical {

// Looks at one window of a tracked board, with the `circles` that were measured in it, and counts it.
// A board that lies one step off has circles beyond one edge and none at the other: that view says nothing.
void judgeExtent(const BurstWindow& window, const BoardMotion& motion,
                 const std::vector<CircleObservation>& circles, const BoardScene& scene, double half_slot_s,
                 const FrontEndOptions& options, BoardExtent& extent);

}  // namespace evical
