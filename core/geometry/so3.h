// Rotations: exponential, logarithm and their Jacobians. Right-hand perturbations throughout:
// R -> R Exp(delta). Formulas: Sola, Deray, Atchuthan,
// "A micro Lie theory for state estimation in robotics" (2018), section IV.  // style: lie
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace evical {

Eigen::Matrix3d skew(const Eigen::Vector3d& v);  // skew(v) w = v x w

Eigen::Matrix3d so3Exp(const Eigen::Vector3d& rotation_vector_rad);
Eigen::Vector3d so3Log(const Eigen::Matrix3d& rotation);  // norm in [0, pi]

// Exp(v + d) = Exp(v) Exp(rightJacobian(v) d) to first order in d; and its inverse.
Eigen::Matrix3d so3RightJacobian(const Eigen::Vector3d& rotation_vector_rad);
Eigen::Matrix3d so3RightJacobianInverse(const Eigen::Vector3d& rotation_vector_rad);

// Both at once, as they share the trigonometry.
void so3ExpAndRightJacobian(const Eigen::Vector3d& rotation_vector_rad, Eigen::Matrix3d& exponential,
                            Eigen::Matrix3d& right_jacobian);

// The shortest rotation from one direction to another. Not inlined: Eigen's version needs a singular value
// decomposition.
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

Eigen::Quaterniond quaternionExp(const Eigen::Vector3d& rotation_vector_rad);
Eigen::Vector3d quaternionLog(const Eigen::Quaterniond& rotation);

// Rotation that best maps source directions to target directions: W. Kabsch, "A solution for the best
// rotation to relate two sets of vectors", 1976.
struct BestRotation {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();  // target_from_source
  Eigen::Vector3d strengths;                             // singular values, the largest first
  Eigen::Vector3d main_axis;  // of the largest singular value, in the target's frame
};

// Rotation for the sum of weight * target * source^T over all pairs; with determinant -1 the best reflection.
BestRotation bestRotation(const Eigen::Matrix3d& sum_of_products, double determinant = 1.0);

// Gravity's direction as two small angles.

// The two world directions of gravity's tilt in the report ("gravity.direction.1", ".2").
inline Eigen::Matrix<double, 3, 2> gravityTilts(const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d down = gravity.normalized();
  const Eigen::Vector3d seed = std::abs(down.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix<double, 3, 2> tilts;
  tilts.col(0) = (seed - seed.dot(down) * down).normalized();
  tilts.col(1) = down.cross(tilts.col(0));
  return tilts;
}

// Rigid transforms, named target_from_source: p_target = target_from_source * p_source.
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
