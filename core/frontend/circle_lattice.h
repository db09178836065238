// Orders circles into a lattice: from a seed circle and two neighbours outwards, each step predicted by its
// neighbours. Outliers and missing circles are normal.
#pragma once

#include "core/frontend/detection_options.h"
#include "core/frontend/moving_circle.h"

#include <vector>

namespace evical {

struct LatticeNode {
  int i = 0, j = 0;        // steps along the lattice's two directions, positively oriented in the image
  std::size_t circle = 0;  // index into the circles
};

using CircleLattice = std::vector<LatticeNode>;

// The lattice with the most circles; empty if no three circles make one.
CircleLattice findCircleLattice(const std::vector<MovingCircle>& circles, const GridOptions& options);

}  // namespace evical
