// Quaternion blocks (x y z w, as Eigen stores them) perturbed on the right: R -> R Exp(delta).
//
// PlusJacobian is [I; 0]: cost functions write derivatives with respect to delta into the first three of the
// four columns, and zero into the last. This avoids the chain rule through the quaternion. These blocks'
// Jacobians can therefore not be compared with derivatives by the quaternion's numbers.
#pragma once

#include <ceres/manifold.h>

namespace evical {

class So3Manifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

}  // namespace evical
