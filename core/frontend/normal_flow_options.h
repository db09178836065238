// Thresholds of the published candidate source (docs/maths.md, 5.2). Lengths are the sensor's own pixels.
#pragma once

#include "core/base/option_struct.h"

namespace evical {

struct NormalFlowOptions {
  int plane_radius_px;
  double largest_plane_error_px;
  double least_plane_inliers;
  double fastest_px_s;
  int dilation_px;
  int least_cluster_px;
  double largest_pair_angle_deg;
  double window_travel_px;

  NormalFlowOptions();  // the defaults
  constexpr explicit NormalFlowOptions(NoDefaults) {}
  bool operator==(const NormalFlowOptions&) const = default;
  static const OptionTable<NormalFlowOptions>& table();
};

}  // namespace evical
