// A length measured on the board with a ruler, from one circle's centre to another in the same line.
#pragma once

#include "core/geometry/board.h"

namespace evical {

struct MeasuredLength {
  int spacings = 10;  // between the circles: 10 from the first of 11 rows to the last
  double length_m = 0.5;
  double std_m = 0.0005;  // of the ruler reading; 0: exact

  bool operator==(const MeasuredLength&) const = default;

  double spacing_m() const { return length_m / spacings; }
  double relativeStd() const { return std_m / length_m; }
};

// Number of spacings in the board's longest line.
int maxSpacings(const Board& board);

// Throws CalibrationError (BadInput, place "board.measured...") if the board has no such line, or a value is
// implausible.
void validate(const MeasuredLength& measured, const Board& board);

}  // namespace evical
