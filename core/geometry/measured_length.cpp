#include "core/geometry/measured_length.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {

int maxSpacings(const Board& board) {
  return static_cast<int>(std::lround(board.extent_m().maxCoeff() / board.spacing_m));
}

void validate(const MeasuredLength& measured, const Board& board) {
  const int most = maxSpacings(board);
  if (measured.spacings < 1 || measured.spacings > most)
    throw badInput(
        "board.measured.spacings",
        fmt::format("{} spacings exceed this board's longest line, which has {}", measured.spacings, most),
        "Count the spacings from the first circle to the last: one less than the number of rows; in a line "
        "of a staggered board, two from circle to circle");
  if (!(measured.length_m > 0.0) || !std::isfinite(measured.length_m))
    throw badInput("board.measured.length_m", "must be greater than 0", "Measure it on the print, in metres");
  constexpr double kLargestShare = 0.1;  // a larger share means that metres and millimetres were confused
  if (!(measured.std_m >= 0.0) || measured.std_m > kLargestShare * measured.length_m)
    throw badInput("board.measured.std_m",
                   fmt::format("a sigma of {} m is not plausible for a length of {} m", measured.std_m,
                               measured.length_m),
                   "Give the sigma of a ruler reading in metres, for example 0.0005 for half a millimetre");
}

}  // namespace evical
