// Thresholds of the published candidate source (docs/maths.md, 5.2). Lengths are the sensor's own pixels.
#pragma once

#include "core/base/option_field.h"

#include <tuple>

namespace evical {

struct NormalFlowOptions {
  int plane_radius_px = 1;
  double largest_plane_error_px = 0.6;
  double least_plane_inliers = 0.5;
  double fastest_px_s = 4000.0;
  int dilation_px = 1;
  int least_cluster_px = 10;
  double largest_pair_angle_deg = 30.0;
  double smallest_radius_px = 2.5;
  double largest_radius_px = 80.0;
  double window_travel_px = 3.5;
  bool operator==(const NormalFlowOptions&) const = default;
};
inline constexpr auto kNormalFlowFields = std::tuple{
    Field{"plane_radius_px", &NormalFlowOptions::plane_radius_px, 1, 5, "px",
          "Half width of the neighbourhood that a plane is fitted to."},
    Field{"largest_plane_error_px", &NormalFlowOptions::largest_plane_error_px, 0.05, 5.0, "px",
          "A neighbour that is off the plane by more than the edge needs for this distance is dropped."},
    Field{"least_plane_inliers", &NormalFlowOptions::least_plane_inliers, 0.2, 1.0, "",
          "Part of the neighbourhood that must lie on the plane."},
    Field{"fastest_px_s", &NormalFlowOptions::fastest_px_s, 10.0, 1e6, "px/s", "Faster edges are noise."},
    Field{"dilation_px", &NormalFlowOptions::dilation_px, 0, 5, "px",
          "Flow within twice this and one more pixel belongs to one cluster."},
    Field{"least_cluster_px", &NormalFlowOptions::least_cluster_px, 3, 10000, "px",
          "Pixels that a cluster must have."},
    Field{"largest_pair_angle_deg", &NormalFlowOptions::largest_pair_angle_deg, 1.0, 90.0, "deg",
          "Between the directions of two arcs of a circle, and the line that joins them."},
    Field{"smallest_radius_px", &NormalFlowOptions::smallest_radius_px, 1.0, 100.0, "px",
          "Smallest circle looked for."},
    Field{"largest_radius_px", &NormalFlowOptions::largest_radius_px, 3.0, 500.0, "px",
          "Largest circle looked for."},
    Field{"window_travel_px", &NormalFlowOptions::window_travel_px, 0.5, 20.0, "px",
          "Edges should travel about this far in a searched window."}};
static_assert(fieldCount<NormalFlowOptions>() == std::tuple_size_v<decltype(kNormalFlowFields)>);

}  // namespace evical
