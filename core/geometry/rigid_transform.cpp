#include "core/geometry/rigid_transform.h"

#include "core/geometry/so3.h"

namespace evical {

RigidTransform operator*(const RigidTransform& a_from_b, const RigidTransform& b_from_c) {
  return {(a_from_b.rotation * b_from_c.rotation).normalized(), a_from_b * b_from_c.translation_m};
}

RigidTransform inverse(const RigidTransform& a_from_b) {
  const Eigen::Quaterniond b_from_a = a_from_b.rotation.conjugate();
  return {b_from_a, -(b_from_a * a_from_b.translation_m)};
}

double rotationAngleBetween_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return quaternionLog(a.conjugate() * b).norm();
}

}  // namespace evical
