// Residuals and derivatives of one residual block of the batch, by its free unknowns, as a dense matrix in
// columns of the tangent space.
#pragma once

#include "core/optimisation/unknown_columns.h"

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
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Map = Eigen::Map<const RowMajorMatrix, 0, Eigen::OuterStride<>>;

  explicit BlockJacobian(const UnknownColumns& columns) : columns_(columns) {}

  void evaluate(std::size_t block, const ManifoldDerivatives& manifolds);
  double evaluateCost(std::size_t block);  // half the sum of squared residuals

  Eigen::Index rows() const { return rows_; }
  const std::vector<Eigen::Index>& splineColumns() const { return spline_columns_; }
  const std::vector<Eigen::Index>& borderColumns() const { return border_columns_; }
  // Columns: splines, border, and the residuals themselves as the last column.
  const double* data() const { return values_.data(); }
  Eigen::Index stride() const { return stride_; }

  Map bySplines() const { return {values_.data(), rows_, splineCount(), Eigen::OuterStride<>(stride_)}; }
  Map byBorder() const {
    return {values_.data() + splineCount(), rows_, stride_ - 1 - splineCount(),
            Eigen::OuterStride<>(stride_)};
  }
  Map residuals() const { return {values_.data() + stride_ - 1, rows_, 1, Eigen::OuterStride<>(stride_)}; }

 private:
  Eigen::Index splineCount() const { return static_cast<Eigen::Index>(spline_columns_.size()); }
  void listColumns(std::span<const std::int32_t> unknowns);
  void copyColumns(const Unknown& unknown, const double* by_numbers, const double* plus, Eigen::Index at);

  const UnknownColumns& columns_;
  Eigen::Index rows_ = 0, stride_ = 0;
  std::vector<Eigen::Index> spline_columns_, border_columns_;
  std::vector<double> values_, residuals_, by_numbers_;
  std::vector<const double*> parameters_;
  std::vector<double*> jacobians_;
};

}  // namespace evical
