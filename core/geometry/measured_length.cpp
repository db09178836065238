#include "core/geometry/measured_length.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {

int mostSpacings(const Board& board) {
  return static_cast<int>(std::lround(board.extent_m().maxCoeff() / board.spacing_m));
}

void validate(const MeasuredLength& measured, const Board& board) {
  const int most = mostSpacings(board);
  if (measured.spacings < 1 || measured.spacings > most)
    throw badInput("board.measured.spacings",
                   fmt::format("{} spacings are not in any line of this board: it has up to {}",
                               measured.spacings, most),
                   "From the first circle to the last there is one less than there are rows; in a line of a "
                   "staggered board two from circle to circle");
  if (!(measured.length_m > 0.0) || !std::isfinite(measured.length_m))
    throw badInput("board.measured.length_m", "must be greater than 0", "Measure it on the print, in metres");
  constexpr double kLargestShare = 0.1;  // beyond it metres and millimetres were mixed up
  if (!(measured.std_m >= 0.0) || measured.std_m > kLargestShare * measured.length_m)
    throw badInput("board.measured.std_m",
                   fmt::format("{} m is no sigma of a length of {} m", measured.std_m, measured.length_m),
                   "Give that of ruler and eye, in metres: 0.0005 is half a millimetre");
}

}  // namespace evical
