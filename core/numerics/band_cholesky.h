// Cholesky factor of a symmetric positive definite band matrix, in linear time: what a spline's information
// matrix is, with the control points in order of time.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace evical {

class BandCholesky {
 public:
  // `half_bandwidth`: largest distance of an entry from the diagonal.
  BandCholesky(Eigen::Index size, Eigen::Index half_bandwidth);

  Eigen::Index size() const { return size_; }
  void add(Eigen::Index row, Eigen::Index col, double value) { at(row, col) += value; }  // col <= row
  // Adds scale * weights weights^T at (first, first).
  void addOuter(Eigen::Index first, const Eigen::Ref<const Eigen::VectorXd>& weights, double scale);

  // In place; afterwards nothing may be added. False if directions have no information (pivots that cancel to
  // nothing): these get a solution of 0 instead of infinity.
  bool factorise();
  // Overwrites `right` (size x any) with the solution.
  void solveInPlace(Eigen::Ref<Eigen::MatrixXd> right) const;

  // L^-T times `white`: with independent unit variances in, values with the inverse's covariance.
  void correlateInPlace(Eigen::VectorXd& white) const;

 private:
  void solveTransposed(double* x) const;
  double& at(Eigen::Index row, Eigen::Index col) { return band_[index(row, col)]; }
  double at(Eigen::Index row, Eigen::Index col) const { return band_[index(row, col)]; }
  std::size_t index(Eigen::Index row, Eigen::Index col) const {
    return static_cast<std::size_t>(row * (half_bandwidth_ + 1) + half_bandwidth_ + col - row);
  }

  Eigen::Index size_, half_bandwidth_;
  std::vector<double> band_;  // row by row, the diagonal last
};

}  // namespace evical
