// Deviation of a board from a plane: curvatures as heights over the board's lengths.
#pragma once

#include "core/data/calibration_state.h"
#include "core/data/quantity.h"
#include "core/geometry/board.h"

#include <string>

namespace evical {

// Height for one unit of this curvature (row_curvature, column_curvature, twist): of the middle of a row or
// column over its ends; for a twist, of two corners over the plane of the other two.
double bowHeight_m2(QuantityId curvature, const Board& board);

// Description of the largest one: "the board seems bent: over the 0.5 m of its columns, the middle protrudes
// by 1.1 mm".
std::string bowWords(const BoardState& state, const Board& board, const std::string& called = "board");

// Its magnitude in mm.
double largestBow_mm(const BoardState& state, const Board& board);

}  // namespace evical
