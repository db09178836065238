// Check whether the lattice of circles ends at the board's edges. A session may specify too few or too many
// rows or columns, and the board is detected nevertheless.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/window_trace.h"

namespace evical {

// Checks one window in which the board was tracked, and adds to the counts. A board that is misplaced by one
// step has circles beyond one edge and none at the opposite one: such a view is not counted.
void judgeExtent(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                 const FrontEndOptions& options, BoardExtent& extent);

// Counts a view that shows both ends of the lattice, with so many lines between them.
void countWhole(int lines, LatticeEnds& ends);

}  // namespace evical
