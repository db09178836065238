#include "core/optimisation/so3_manifold.h"

#include "core/geometry/so3.h"

namespace evical {

bool So3Manifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Map<const Eigen::Quaterniond> rotation(x);
  const Eigen::Vector3d step(delta[0], delta[1], delta[2]);
  Eigen::Map<Eigen::Quaterniond> moved(x_plus_delta);
  moved = (rotation * quaternionExp(step)).normalized();
  return true;
}

bool So3Manifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 4, 3, Eigen::RowMajor>> j(jacobian);
  j.setZero();
  j.topRows<3>().setIdentity();
  return true;
}

bool So3Manifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Eigen::Map<const Eigen::Quaterniond> to(y), from(x);
  Eigen::Map<Eigen::Vector3d> difference(y_minus_x);
  difference = quaternionLog(from.conjugate() * to);
  return true;
}

bool So3Manifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> j(jacobian);
  j.setZero();
  j.leftCols<3>().setIdentity();
  return true;
}

}  // namespace evical
