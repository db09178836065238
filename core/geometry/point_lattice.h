// Ordering of circles in a lattice: from a seed circle and two neighbours outwards, with each step predicted
// by its neighbours. Tolerates outliers and missing circles.
#pragma once

#include "core/geometry/board.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace evical {

struct LatticeCircle {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double radius_px = 0.0;
};

struct LatticeOptions {
  double min_step_radii = 0.0;  // between neighbours, in their radii
  double max_step_radii = 0.0;
  double max_radius_ratio = 0.0;  // between neighbours
  double step_tolerance = 0.0;    // distance from the predicted place, relative to a step
  double min_sine = 0.0;          // between the lattice's two directions
  int min_circles = 0;            // of a lattice
};

struct LatticeNode {
  int i = 0, j = 0;        // steps along the lattice's two directions, positively oriented in the image
  std::size_t circle = 0;  // index into the circles
};

using CircleLattice = std::vector<LatticeNode>;

// The lattice with the most circles; empty if no three circles form one.
CircleLattice findCircleLattice(const std::vector<LatticeCircle>& circles, const LatticeOptions& options);

// Placements of a lattice of circles on a board of circles: rotated, sheared and shifted.

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
