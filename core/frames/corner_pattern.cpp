#include "core/frames/corner_pattern.h"

#include "core/geometry/tag_bits.h"

#include <algorithm>

namespace evical {
namespace {

std::vector<bool> alternating(const Board& board, bool first) {
  std::vector<bool> dark_ahead(static_cast<std::size_t>(board.pointCount()));
  for (int k = 0; k < board.pointCount(); ++k) {
    const int row = k / board.pointsInRow(), col = k % board.pointsInRow();
    dark_ahead[static_cast<std::size_t>(k)] = ((row + col) % 2 == 0) == first;
  }
  return dark_ahead;
}

}  // namespace

CornerPattern checkerboardCorners(const Board& board) {
  return {board.spacing_m, alternating(board, true)};
}

CornerPattern tagGridCorners(const Board& board, int border_bits) {
  const double border_m = board.tag_size_m * border_bits / (kTagSide_bits + 2 * border_bits);
  CornerPattern pattern{std::min(border_m, board.spacing_m - board.tag_size_m), {}};
  // From the bottom left counterclockwise: the tag itself is towards +x -y, -x -y, -x +y, +x +y.
  for (int k = 0; k < board.pointCount(); ++k) pattern.dark_ahead.push_back(k % 2 == 1);
  return pattern;
}

CornerPattern charucoCorners(const Board& board, bool first_is_bright) {
  return {0.5 * (board.spacing_m - board.tag_size_m), alternating(board, !first_is_bright)};
}

}  // namespace evical
