#include "core/optimisation/smoothness_cost.h"

#include "core/geometry/so3.h"

namespace evical {
namespace {

// Derivative by delta, as So3Manifold requires.
void writeByRotation(const Eigen::Matrix3d& by_delta, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> out(jacobian);
  out.leftCols<3>() = by_delta;
  out.rightCols<1>().setZero();
}

}  // namespace

SmoothRotationCost::SmoothRotationCost(double knot_spacing_s, double sigma_rad_s2)
    : weight_(1.0 / (sigma_rad_s2 * knot_spacing_s * knot_spacing_s)) {}

bool SmoothRotationCost::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const Eigen::Map<const Eigen::Quaterniond> a(parameters[0]), b(parameters[1]), c(parameters[2]);
  const Eigen::Vector3d before = quaternionLog(a.conjugate() * b), after = quaternionLog(b.conjugate() * c);
  Eigen::Map<Eigen::Vector3d>{residuals} = weight_ * (after - before);
  if (!jacobians) return true;
  // d Log(A^T B) by B: inverse right Jacobian; by A: minus the inverse left one, which is its transpose.
  const Eigen::Matrix3d by_later_before = so3RightJacobianInverse(before),
                        by_later_after = so3RightJacobianInverse(after);
  if (jacobians[0]) writeByRotation(weight_ * by_later_before.transpose(), jacobians[0]);
  if (jacobians[1]) writeByRotation(-weight_ * (by_later_after.transpose() + by_later_before), jacobians[1]);
  if (jacobians[2]) writeByRotation(weight_ * by_later_after, jacobians[2]);
  return true;
}

SmoothPositionCost::SmoothPositionCost(double knot_spacing_s, double sigma_m_s2)
    : weight_(1.0 / (sigma_m_s2 * knot_spacing_s * knot_spacing_s)) {}

bool SmoothPositionCost::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const Eigen::Map<const Eigen::Vector3d> a(parameters[0]), b(parameters[1]), c(parameters[2]);
  Eigen::Map<Eigen::Vector3d>{residuals} = weight_ * (a - 2.0 * b + c);
  if (!jacobians) return true;
  constexpr double kWeights[] = {1.0, -2.0, 1.0};
  for (int k = 0; k < 3; ++k) {
    if (!jacobians[k]) continue;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[k]} =
        weight_ * kWeights[k] * Eigen::Matrix3d::Identity();
  }
  return true;
}

}  // namespace evical
