// Connected regions of normal flow, classified as parts of a moving circle (docs/maths.md, 5.2; S.
// Chen et al., "eKalibr", 2501.05688).
#pragma once

#include "core/frontend/normal_flow.h"

#include "core/geometry/resolution.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace evical {

enum class ClusterKind {
  Run,    // flows diverge: leading arc
  Chase,  // flows converge: trailing arc
  Other,
};

struct EventCluster {
  bool leading = false;              // by polarity
  std::vector<std::uint32_t> flows;  // indices into the field
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // of the mean flow, unit
  ClusterKind kind = ClusterKind::Other;
};

std::vector<EventCluster> clusterFlow(const NormalFlowField& field, Resolution resolution_px,
                                      const NormalFlowOptions& options);

}  // namespace evical
