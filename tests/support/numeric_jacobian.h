// Central differences, the reference for every analytic derivative.
#pragma once

#include <Eigen/Core>

namespace evical::test {

// Columns of d(value)/d(delta) at delta = 0, for a function Eigen::VectorXd(const Eigen::VectorXd& delta).
// Fourth order: the truncation error is step^4, so that a large step keeps rounding small.
template <class Function>
Eigen::MatrixXd numericJacobian(const Function& value, Eigen::Index size, double step) {
  Eigen::MatrixXd jacobian;
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto at = [&](double distance) -> Eigen::VectorXd {
      Eigen::VectorXd delta = Eigen::VectorXd::Zero(size);
      delta[i] = distance;
      return value(delta);
    };
    const Eigen::VectorXd column =
        (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
    if (i == 0) jacobian.resize(column.size(), size);
    jacobian.col(i) = column;
  }
  return jacobian;
}

// Largest difference, relative to the largest entry (but at least 1).
inline double relativeDifference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.size() == 0) return b.size() == 0 ? 0.0 : 1.0;
  return (a - b).cwiseAbs().maxCoeff() / std::max(1.0, b.cwiseAbs().maxCoeff());
}

}  // namespace evical::test
