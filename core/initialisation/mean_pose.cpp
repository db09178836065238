#include "core/initialisation/mean_pose.h"

#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <cmath>

namespace evical {

double PoseSpread::between2(const RigidTransform& a, const RigidTransform& b) const {
  return squared(rotationAngleBetween_rad(a.rotation, b.rotation),
                 (a.translation_m - b.translation_m).norm());
}

MeanPose meanPose(std::span<const RigidTransform> poses, const RigidTransform& start,
                  const PoseSpread& spread, int rounds) {
  MeanPose result;
  result.mean = start;
  RigidTransform& mean = result.mean;
  for (int round = 0; round < rounds; ++round) {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
    double weights = 0.0, turns2 = 0.0, shifts2 = 0.0;
    int near = 0;
    for (const RigidTransform& pose : poses) {
      const Eigen::Vector3d angle = quaternionLog(mean.rotation.conjugate() * pose.rotation),
                            way = pose.translation_m - mean.translation_m;
      const double weight = cauchyWeight(spread.squared(angle.norm(), way.norm()));
      near += weight > 0.5;
      turn += weight * angle;
      shift += weight * way;
      weights += weight;
      turns2 += weight * angle.squaredNorm();
      shifts2 += weight * way.squaredNorm();
    }
    mean.rotation = (mean.rotation * quaternionExp(turn / weights)).normalized();
    mean.translation_m += shift / weights;
    result.agreeing = static_cast<double>(near) / static_cast<double>(poses.size());
    result.rotation_rms_rad = std::sqrt(turns2 / weights);
    result.position_rms_m = std::sqrt(shifts2 / weights);
  }
  return result;
}

}  // namespace evical
