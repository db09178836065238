// The lattice of squares in events that are too few for normal flow. The signed count of a window's events is
// the image at its end minus that at its beginning. Squares of a checkerboard are two plane waves along their
// diagonals there, whose phases give the lattice. Between the window's halves the phases advance by the
// motion, whose sign gives the image's sign (docs/maths.md, 5.8).
#pragma once

#include "core/frontend/burst_window.h"
#include "core/frontend/corner_lattice.h"

#include <vector>

namespace evical {

// Corners in sensor pixels, as a lattice of saddles, and their mean velocity.
struct WaveLattice {
  std::vector<SaddleCandidate> saddles;
  CornerLattice corners;
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
};

// Up to two lattices, best first; the right one is often, but not always, the first.
std::vector<WaveLattice> findLatticeWaves(const BurstWindow& window, double half_window_s);

}  // namespace evical
