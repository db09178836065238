// Placements of a lattice of circles on a board of circles: rotated, sheared and shifted.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/point_lattice.h"

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace evical {

using LatticePlace = std::pair<int, int>;
using LatticeMap = std::array<int, 4>;  // row by row

inline constexpr std::array<LatticeMap, 4> kLatticeTurns = {
    {{1, 0, 0, 1}, {0, -1, 1, 0}, {-1, 0, 0, -1}, {0, 1, -1, 0}}};

LatticePlace applied(const LatticeMap& map, const LatticePlace& place);

// The board's circles in steps of the board's square lattice, positively oriented like the image's.
std::map<LatticePlace, int> boardLattice(const Board& board);

struct LatticePlacement {
  LatticeMap map;                                    // of the lattice, before it is shifted
  std::vector<std::pair<int, std::size_t>> circles;  // board circle, index of the circle
};

// Placements with at least `nearly` (a ratio) as many circles on the board as the best one, in descending
// order.
std::vector<LatticePlacement> layOnBoard(const CircleLattice& lattice, const Board& board, double nearly);

}  // namespace evical
