// Symmetric matrices that are a band with a border, [ A  B ; B^T  C ]: the normal equations of a trajectory's
// control points in order of time, A, and of a few dozen parameters, C, that depend on all of them. Solved in
// linear time: A's Cholesky factor L row by row, with C - (L^-1 B)^T L^-1 B at the same time, without storing
// L^-1 B.
#pragma once

#include "core/numerics/band_cholesky.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

class BorderedBand {
 public:
  using RowMajorMatrix = BandCholesky::RowMajorMatrix;

  // `half_bandwidth`: largest distance of A's entries from its diagonal.
  BorderedBand(Eigen::Index size, Eigen::Index half_bandwidth, Eigen::Index border)
      : band_(size, half_bandwidth),
        mixed_(RowMajorMatrix::Zero(size, border)),
        corner_(Eigen::MatrixXd::Zero(border, border)) {}

  // Keeps its memory where it suffices; entries are undefined.
  void resize(Eigen::Index size, Eigen::Index half_bandwidth, Eigen::Index border) {
    band_.resize(size, half_bandwidth);
    mixed_.resize(size, border);
    corner_.resize(border, border);
  }

  Eigen::Index borderSize() const { return mixed_.cols(); }
  Eigen::Index size() const { return band_.size() + borderSize(); }
  void setZero();

  BandCholesky& band() { return band_; }  // A, not factored
  const BandCholesky& band() const { return band_; }
  RowMajorMatrix& mixed() { return mixed_; }     // B
  Eigen::MatrixXd& corner() { return corner_; }  // C; the lower triangle is used

  Eigen::VectorXd diagonal() const;

  // x with (this + diag(added)) x = right; empty if that matrix is not positive definite. Overwrites
  // `factor`, whose memory several solutions share.
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& added, const Eigen::VectorXd& right,
                                       BandCholesky& factor) const;

  // C - B^T A^-1 B; directions without information in A are left out.
  Eigen::MatrixXd schurComplement() const;

 private:
  BandCholesky band_;
  RowMajorMatrix mixed_;
  Eigen::MatrixXd corner_;
};

}  // namespace evical
