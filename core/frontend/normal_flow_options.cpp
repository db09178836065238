#include "core/frontend/normal_flow_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kNormalFlowFields{
    Field{"plane_radius_px", &NormalFlowOptions::plane_radius_px, 1, within(1, 5), "px",
          "Half width of the neighbourhood that a plane is fitted to."},
    Field{"largest_plane_error_px", &NormalFlowOptions::largest_plane_error_px, 0.6, within(0.05, 5.0), "px",
          "A neighbour that is off the plane by more than the edge needs for this distance is dropped."},
    Field{"least_plane_inliers", &NormalFlowOptions::least_plane_inliers, 0.5, within(0.2, 1.0), "",
          "Part of the neighbourhood that must lie on the plane."},
    Field{"fastest_px_s", &NormalFlowOptions::fastest_px_s, 4000.0, within(10.0, 1e6), "px/s",
          "Faster edges are noise."},
    Field{"dilation_px", &NormalFlowOptions::dilation_px, 1, within(0, 5), "px",
          "Flow within twice this and one more pixel belongs to one cluster."},
    Field{"least_cluster_px", &NormalFlowOptions::least_cluster_px, 10, within(3, 10000), "px",
          "Pixels that a cluster must have."},
    Field{"largest_pair_angle_deg", &NormalFlowOptions::largest_pair_angle_deg, 30.0, within(1.0, 90.0),
          "deg", "Between the directions of two arcs of a circle, and the line that joins them."},
    Field{"window_travel_px", &NormalFlowOptions::window_travel_px, 3.5, within(0.5, 20.0), "px",
          "Edges should travel about this far in a searched window."}};
constexpr auto kNormalFlowDefaults = defaultsOf<NormalFlowOptions, kNormalFlowFields>();

}  // namespace

NormalFlowOptions::NormalFlowOptions() : NormalFlowOptions(kNormalFlowDefaults) {}

const OptionTable<NormalFlowOptions>& NormalFlowOptions::table() {
  static const OptionTable<NormalFlowOptions> table(kNormalFlowFields);
  return table;
}

}  // namespace evical
