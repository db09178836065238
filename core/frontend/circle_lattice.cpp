#include "core/frontend/circle_lattice.h"

namespace evical {

CircleLattice findCircleLattice(const std::vector<MovingCircle>& circles, const GridOptions& options) {
  std::vector<LatticeCircle> still;
  still.reserve(circles.size());
  for (const MovingCircle& circle : circles) still.push_back({circle.centre_px, circle.radius_px});
  const LatticeOptions lattice = {.shortest_step_radii = options.shortest_step_radii,
                                  .longest_step_radii = options.longest_step_radii,
                                  .largest_radius_ratio = options.largest_radius_ratio,
                                  .step_tolerance = options.step_tolerance,
                                  .least_sine = options.least_sine,
                                  .least_circles = options.least_circles};
  return findCircleLattice(still, lattice);
}

}  // namespace evical
