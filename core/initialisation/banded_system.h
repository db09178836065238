// A symmetric positive definite system of bandwidth 3 bordered by a few dense unknowns: splines and what they
// share. Solved in linear time.
#pragma once

#include <Eigen/Core>

namespace evical {

class BandedMatrix {
 public:
  static constexpr int kBand = 4;  // entries of a row at and left of the diagonal

  explicit BandedMatrix(Eigen::Index size) : rows_(Eigen::MatrixXd::Zero(kBand, size)) {}

  Eigen::Index size() const { return rows_.cols(); }
  // Adds scale * weights weights^T at (first, first).
  void addOuter(Eigen::Index first, const Eigen::Vector4d& weights, double scale);

  // Cholesky in place; afterwards only solve may be called. False if not positive definite.
  bool factorise();
  // Overwrites `right` (size x any) with the solution.
  void solveInPlace(Eigen::Ref<Eigen::MatrixXd> right) const;

 private:
  Eigen::MatrixXd rows_;  // rows_(d, i) = A(i, i - d), then L(i, i - d)
};

}  // namespace evical
