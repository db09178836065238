// Cholesky factor of a symmetric positive definite band matrix, in linear time. The information matrix of a
// spline has this form, with the control points in order of time.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace evical {

class BandCholesky {
 public:
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // `half_bandwidth`: largest distance of an entry from the diagonal.
  BandCholesky(Eigen::Index size, Eigen::Index half_bandwidth);

  // Keeps its memory where it suffices; entries are undefined.
  void resize(Eigen::Index size, Eigen::Index half_bandwidth);

  Eigen::Index size() const { return size_; }
  Eigen::Index halfBandwidth() const { return half_bandwidth_; }
  void setZero() { std::fill(band_.begin(), band_.end(), 0.0); }
  // Pointer to a row, whose entry at `col` is [col], for firstOf(row) <= col <= row.
  double* row(Eigen::Index row) { return band_.data() + offsetOf(row); }
  const double* row(Eigen::Index row) const { return band_.data() + offsetOf(row); }
  Eigen::Index firstOf(Eigen::Index row) const { return std::max<Eigen::Index>(0, row - half_bandwidth_); }
  void add(Eigen::Index row, Eigen::Index col, double value) { this->row(row)[col] += value; }  // col <= row
  // Adds scale * weights weights^T at (first, first).
  void addOuter(Eigen::Index first, const Eigen::Ref<const Eigen::VectorXd>& weights, double scale);

  // In place; do not add anything afterwards. False if directions have no information (pivots that cancel):
  // their solution is 0 instead of infinite.
  bool factorise();
  // Factors one row after the rows before it, with `added` on its diagonal. The pivot has no information if
  // it is less than `min_share` of the diagonal.
  bool factoriseRow(Eigen::Index row, double added, double min_share);
  bool factoriseRow(Eigen::Index row);

  // Replaces `right` (size x any) by the solution.
  void solveInPlace(Eigen::Ref<Eigen::MatrixXd> right) const;
  // The same for many columns, row by row.
  void solveInPlace(RowMajorMatrix& right) const;

  // L^-T times `white`: independent values of unit variance become values with the inverse as covariance.
  void correlateInPlace(Eigen::VectorXd& white) const;

 private:
  void solveTransposed(double* x) const;
  Eigen::Index offsetOf(Eigen::Index row) const {
    return row * (half_bandwidth_ + 1) + half_bandwidth_ - row;
  }

  Eigen::Index size_, half_bandwidth_;
  std::vector<double> band_;  // row by row, the diagonal last
};

}  // namespace evical
