// How far a board is from flat, for people: curvatures as heights over the board's own lengths.
#pragma once

#include "core/data/calibration_state.h"
#include "core/data/quantity.h"
#include "core/geometry/board.h"

#include <string>

namespace evical {

// What one unit of this curvature (row_curvature, column_curvature, twist) makes of it: by how much the middle of its
// rows, or of its columns, stands out against their ends; of a twist, two corners against the other two's plane.
double bowHeight_m2(QuantityId curvature, const Board& board);

// "the board seems bent: over the 0.5 m of its columns the middle stands out by 1.1 mm"; of the largest.
std::string bowWords(const BoardState& state, const Board& board, const std::string& called = "board");

// That in mm, without a sign.
double largestBow_mm(const BoardState& state, const Board& board);

}  // namespace evical
