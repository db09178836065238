// Elimination of the splines, and of drifting biases' knots, from the batch's normal equations: the
// information on the quantities if all else is free to follow (projected_information.h).
#pragma once

#include "core/numerics/band_cholesky.h"
#include "core/optimisation/normal_equations.h"
#include "core/optimisation/unknown_columns.h"

#include <Eigen/Core>

namespace evical {

class SplineElimination {
 public:
  using RowMajorMatrix = BandCholesky::RowMajorMatrix;

  // `equations`: with the same columns.
  SplineElimination(const UnknownColumns& columns, NormalEquations equations);

  Eigen::Index quantities() const { return eliminated_.cols(); }
  // Derivatives of a control point, or a knot, by the quantities. P is J_q + J_x followers of x + J_k
  // followers of k.
  auto ofSpline(Eigen::Index column) const { return -eliminated_.row(column); }
  auto ofKnot(Eigen::Index column) const { return -drift_by_quantities_.row(column); }

  const BandCholesky& splines() const { return splines_; }  // factored
  // Negative derivatives of knots by quantities, and the knots' covariance if known.
  const Eigen::MatrixXd& driftByQuantities() const { return drift_by_quantities_; }
  const Eigen::MatrixXd& driftCovariance() const { return drift_covariance_; }

 private:
  void eliminateDrift(Eigen::Index quantities, const Eigen::MatrixXd& corner,
                      const RowMajorMatrix& knots_with_splines);

  BandCholesky splines_;
  RowMajorMatrix eliminated_;  // (J_x^T J_x)^-1 J_x^T J_q, with knots following
  Eigen::MatrixXd drift_by_quantities_, drift_covariance_;
};

}  // namespace evical
