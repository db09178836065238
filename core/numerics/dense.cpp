#include "core/numerics/dense.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace evical {

SymmetricEigen symmetricEigen(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& square) {
  return square.inverse();
}

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a * b;
}

Eigen::MatrixXd productTransposed(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a * b.transpose();
}

Eigen::MatrixXd congruence(const Eigen::MatrixXd& a, const Eigen::MatrixXd& m) {
  return productTransposed(product(a, m), a);
}

}  // namespace evical
