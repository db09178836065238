// Residuals and derivatives of one residual block of the batch, by its free unknowns, as a dense matrix in
// columns of the tangent space.
#pragma once

#include "core/optimisation/unknown_columns.h"
#include "core/optimisation/view_cost.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

// Derivatives of numbers by their tangent space at one state, by index of the unknown. Only stored if they
// are not the first columns of the numbers' derivatives.
class ManifoldDerivatives {
 public:
  explicit ManifoldDerivatives(const UnknownColumns& columns);
  const double* of(std::size_t unknown) const { return derivatives_[unknown].data(); }  // row-major

 private:
  std::vector<std::vector<double>> derivatives_;  // empty if not needed
};

class BlockJacobian {
 public:
  explicit BlockJacobian(const UnknownColumns& columns) : columns_(columns) {}

  void evaluate(std::size_t block, const ManifoldDerivatives& manifolds);
  double evaluateCost(std::size_t block);  // half the sum of squared residuals

  Eigen::Index rows() const { return count_; }
  const std::vector<Eigen::Index>& splineColumns() const { return spline_columns_; }
  const std::vector<Eigen::Index>& borderColumns() const { return border_columns_; }
  std::size_t columnCount() const { return spline_columns_.size() + border_columns_.size(); }

  using Map = Eigen::Map<const ViewRows::RowMajorMatrix, 0, Eigen::OuterStride<>>;

  // Rows in the block's own columns: those of its splines and border, or of poses that depend on the first of
  // them.
  Map ownRows() const {
    return {rows_.values.data(), count_, rows_.stride - 1, Eigen::OuterStride<>(rows_.stride)};
  }
  Map residuals() const {
    return {rows_.values.data() + rows_.stride - 1, count_, 1, Eigen::OuterStride<>(rows_.stride)};
  }
  // Derivatives of the own columns from those of the splines' columns and the border's.
  Eigen::MatrixXd ofOwnColumns(const Eigen::MatrixXd& of_columns) const;
  // J^T r of each two successive rows, in own columns.
  Eigen::MatrixXd pairScores() const;
  // The lower triangle of R^T R, row by row, R being the splines' columns, the border's, and the residuals.
  void products(std::vector<double>& products) const;
  // Sum of the rows times these weights, by the splines' columns and the border's.
  Eigen::VectorXd weightedSum(const Eigen::VectorXd& weights) const;

 private:
  void listColumns(std::span<const std::int32_t> unknowns);
  void evaluateView(const ViewCost& view, std::span<const std::int32_t> unknowns);
  void copyColumns(const Unknown& unknown, const double* by_numbers, const double* plus, Eigen::Index at);

  const UnknownColumns& columns_;
  Eigen::Index count_ = 0;
  std::vector<Eigen::Index> spline_columns_, border_columns_;
  ViewRows rows_;  // without poses, if the block is not a view
  std::vector<double> residuals_, by_numbers_;
  std::vector<int> widths_;
  std::vector<const double*> parameters_;
  std::vector<double*> jacobians_;
};

}  // namespace evical
