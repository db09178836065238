#include "core/frontend/normal_flow_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kNormalFlowFields{
    Field{"plane_radius_px", &NormalFlowOptions::plane_radius_px, 1, within(1, 5), "px",
          "Half width of the neighbourhood of the plane fit."},
    Field{"largest_plane_error_px", &NormalFlowOptions::largest_plane_error_px, 0.6, within(0.05, 5.0), "px",
          "Largest deviation of a neighbour from the plane, as a distance that the edge travels."},
    Field{"least_plane_inliers", &NormalFlowOptions::least_plane_inliers, 0.5, within(0.2, 1.0), "",
          "Smallest share of inliers in the neighbourhood."},
    Field{"fastest_px_s", &NormalFlowOptions::fastest_px_s, 4000.0, within(10.0, 1e6), "px/s",
          "Largest speed of edges; faster ones are noise."},
    Field{"dilation_px", &NormalFlowOptions::dilation_px, 1, within(0, 5), "px",
          "Dilation of flow pixels; pixels that touch after it are one cluster."},
    Field{"least_cluster_px", &NormalFlowOptions::least_cluster_px, 10, within(3, 10000), "px",
          "Smallest number of pixels in a cluster."},
    Field{"largest_pair_angle_deg", &NormalFlowOptions::largest_pair_angle_deg, 30.0, within(1.0, 90.0),
          "deg", "Largest angle between the directions of two paired arcs, and to the line that joins them."},
    Field{"window_travel_px", &NormalFlowOptions::window_travel_px, 3.5, within(0.5, 20.0), "px",
          "Distance that edges travel in a searched window, approximately."}};
constexpr auto kNormalFlowDefaults = defaultsOf<NormalFlowOptions, kNormalFlowFields>();

}  // namespace

NormalFlowOptions::NormalFlowOptions() : NormalFlowOptions(kNormalFlowDefaults) {}

const OptionTable<NormalFlowOptions>& NormalFlowOptions::table() {
  static const OptionTable<NormalFlowOptions> table(kNormalFlowFields);
  return table;
}

}  // namespace evical
