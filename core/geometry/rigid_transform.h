// Rigid transforms, named target_from_source: p_target = target_from_source * p_source.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace evical {

struct RigidTransform {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
};

inline Eigen::Vector3d operator*(const RigidTransform& a_from_b, const Eigen::Vector3d& point_in_b) {
  return a_from_b.rotation * point_in_b + a_from_b.translation_m;
}

// a_from_c = a_from_b * b_from_c
RigidTransform operator*(const RigidTransform& a_from_b, const RigidTransform& b_from_c);

// inverse(a_from_b) = b_from_a
RigidTransform inverse(const RigidTransform& a_from_b);

// Angle between two rotations, [0, pi].
double rotationAngleBetween_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

}  // namespace evical
