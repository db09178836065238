#include "core/optimisation/uncertainty/spline_elimination.h"

#include <Eigen/Cholesky>

#include <utility>

namespace evical {

SplineElimination::SplineElimination(const UnknownColumns& columns, NormalEquations equations)
    : splines_(std::move(equations.matrix.band())), eliminated_(std::move(equations.matrix.mixed())) {
  splines_.factorise();
  const RowMajorMatrix knots = eliminated_.rightCols(columns.driftSize());
  splines_.solveInPlace(eliminated_);
  if (columns.driftSize() > 0) eliminateDrift(columns.quantitySize(), equations.matrix.corner(), knots);
}

void SplineElimination::eliminateDrift(Eigen::Index quantities, const Eigen::MatrixXd& corner,
                                       const RowMajorMatrix& knots_with_splines) {
  const Eigen::Index knots = knots_with_splines.cols();
  Eigen::MatrixXd schur = corner.bottomRows(knots);
  schur.rightCols(knots).triangularView<Eigen::StrictlyUpper>() = schur.rightCols(knots).transpose();
  schur.noalias() -= knots_with_splines.transpose() * eliminated_;
  const Eigen::LDLT<Eigen::MatrixXd> solver(schur.rightCols(knots));
  drift_covariance_ = solver.solve(Eigen::MatrixXd::Identity(knots, knots));
  drift_by_quantities_ = solver.solve(schur.leftCols(quantities));
  RowMajorMatrix kept = eliminated_.leftCols(quantities);
  kept.noalias() -= eliminated_.rightCols(knots) * drift_by_quantities_;
  eliminated_ = std::move(kept);
}

}  // namespace evical
