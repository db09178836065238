// The lattice of moving circles, with the front end's options.
#pragma once

#include "core/frontend/detection_options.h"
#include "core/frontend/moving_circle.h"
#include "core/geometry/point_lattice.h"

#include <vector>

namespace evical {

CircleLattice findCircleLattice(const std::vector<MovingCircle>& circles, const GridOptions& options);

}  // namespace evical
