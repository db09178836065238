// A board's measured length: with a ruler, from one circle's centre to that of another in the same line.
#pragma once

#include "core/geometry/board.h"

namespace evical {

struct MeasuredLength {
  int spacings = 10;  // between the circles: from the first of 11 rows to the last there are 10
  double length_m = 0.5;
  double std_m = 0.0005;  // of ruler and eye; 0: exact

  bool operator==(const MeasuredLength&) const = default;

  double spacing_m() const { return length_m / spacings; }
  double relativeStd() const { return std_m / length_m; }
};

// In the board's longest line.
int mostSpacings(const Board& board);

// Throws CalibrationError (BadInput, place "board.measured...") where the board has no such line, or nobody measures so.
void validate(const MeasuredLength& measured, const Board& board);

}  // namespace evical
