// Mean of several estimates of one pose, with robust weights.
#pragma once

#include "core/geometry/rigid_transform.h"

#include <span>

namespace evical {

// Distances at which a pose has half its weight.
struct PoseSpread {
  double rotation_rad = 0.0, position_m = 0.0;

  // Squared distance in these units: for an angle and a distance, and between two poses.
  double squared(double angle_rad, double way_m) const {
    const double angle = angle_rad / rotation_rad, way = way_m / position_m;
    return angle * angle + way * way;
  }
  double between2(const RigidTransform& a, const RigidTransform& b) const;
};

struct MeanPose {
  RigidTransform mean;                                  // target_from_source, like the poses
  double agreeing = 0.0;                                // share of poses close to the mean
  double rotation_rms_rad = 0.0, position_rms_m = 0.0;  // robust
};
// `start`: close to most of them.
MeanPose meanPose(std::span<const RigidTransform> poses, const RigidTransform& start,
                  const PoseSpread& spread, int rounds);

}  // namespace evical
