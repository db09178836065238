// Motion of edges along their normals, from planes through the times of neighbouring pixels
// (docs/maths.md, 5.2; R. Benosman et al., "Event-based visual flow", TNNLS 2014).
#pragma once

#include "core/frontend/active_event_surface.h"
#include "core/frontend/normal_flow_options.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace evical {

struct NormalFlow {
  std::uint16_t x_px, y_px;
  bool leading;
  float time_s;                   // since the window's middle
  Eigen::Vector2f velocity_px_s;  // of the edge, along its normal
};

using NormalFlowField = std::vector<NormalFlow>;

// Flow (a, b) / (a^2 + b^2) at pixels where a plane t = a x + b y + c fits the neighbourhood. The surface
// needs a border of at least plane_radius_px. Deviations from the plane are compared with the distance that
// the edge travels in that time, so slow and fast edges are treated alike.
NormalFlowField estimateNormalFlow(const ActiveEventSurface& surface, const NormalFlowOptions& options);

}  // namespace evical
