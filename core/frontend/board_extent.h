// Does the lattice of circles end where the board does? A session may give too few or too many rows or
// columns, and the board is detected nevertheless.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/window_trace.h"

namespace evical {

// Checks one window in which the board was tracked, and counts it. A board that is misplaced by one step has
// circles beyond one edge and none at the other: that view does not count.
void judgeExtent(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                 const FrontEndOptions& options, BoardExtent& extent);

}  // namespace evical
