#include "core/optimisation/block_jacobian.h"

#include "core/numerics/dense.h"

#include <ceres/cost_function.h>
#include <ceres/manifold.h>

#include <algorithm>

namespace evical {

ManifoldDerivatives::ManifoldDerivatives(const UnknownColumns& columns)
    : derivatives_(columns.unknowns().size()) {
  for (std::size_t i = 0; i < derivatives_.size(); ++i) {
    const Unknown& unknown = columns.unknowns()[i];
    if (unknown.columns == 0 || unknown.leading) continue;
    derivatives_[i].resize(static_cast<std::size_t>(unknown.size * unknown.columns));
    unknown.manifold->PlusJacobian(unknown.values, derivatives_[i].data());
  }
}

void BlockJacobian::listColumns(std::span<const std::int32_t> unknowns) {
  spline_columns_.clear();
  border_columns_.clear();
  parameters_.clear();
  for (const std::int32_t index : unknowns) {
    const Unknown& unknown = columns_.unknowns()[static_cast<std::size_t>(index)];
    parameters_.push_back(unknown.values);
    auto& list = unknown.spline ? spline_columns_ : border_columns_;
    for (int k = 0; k < unknown.columns; ++k) list.push_back(unknown.first + k);
  }
}

void BlockJacobian::evaluate(std::size_t block, const ManifoldDerivatives& manifolds) {
  const ceres::CostFunction& cost = columns_.cost(block);
  const std::span<const std::int32_t> unknowns = columns_.unknownsOf(block);
  count_ = cost.num_residuals();
  listColumns(unknowns);
  if (const ViewCost* const view = columns_.view(block)) return evaluateView(*view, unknowns);
  std::size_t numbers = 0;
  for (const std::int32_t index : unknowns)
    numbers += static_cast<std::size_t>(columns_.unknowns()[static_cast<std::size_t>(index)].size);
  by_numbers_.resize(std::max(by_numbers_.size(), numbers * static_cast<std::size_t>(count_)));
  jacobians_.clear();
  double* next = by_numbers_.data();
  for (const std::int32_t index : unknowns) {
    const Unknown& unknown = columns_.unknowns()[static_cast<std::size_t>(index)];
    jacobians_.push_back(unknown.columns > 0 ? next : nullptr);
    if (unknown.columns > 0) next += count_ * unknown.size;
  }
  residuals_.resize(static_cast<std::size_t>(count_));
  cost.Evaluate(parameters_.data(), residuals_.data(), jacobians_.data());
  rows_.stride = static_cast<Eigen::Index>(columnCount()) + 1;
  rows_.chain.resize(0, 0);
  rows_.values.resize(std::max(rows_.values.size(), static_cast<std::size_t>(count_ * rows_.stride)));
  Eigen::Index spline_at = 0, border_at = static_cast<Eigen::Index>(spline_columns_.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (jacobians_[i] == nullptr) continue;
    const auto index = static_cast<std::size_t>(unknowns[i]);
    const Unknown& unknown = columns_.unknowns()[index];
    Eigen::Index& at = unknown.spline ? spline_at : border_at;
    copyColumns(unknown, jacobians_[i], unknown.leading ? nullptr : manifolds.of(index), at);
    at += unknown.columns;
  }
  for (Eigen::Index row = 0; row < count_; ++row)
    rows_.values[static_cast<std::size_t>((row + 1) * rows_.stride - 1)] =
        residuals_[static_cast<std::size_t>(row)];
}

// The tangent spaces of a view's blocks are their leading numbers.
void BlockJacobian::evaluateView(const ViewCost& view, std::span<const std::int32_t> unknowns) {
  widths_.clear();
  for (const std::int32_t index : unknowns.subspan(view.controlPoints()))
    widths_.push_back(columns_.unknowns()[static_cast<std::size_t>(index)].columns);
  view.evaluate(parameters_.data(), widths_, rows_);
}

namespace {

// sums += R^T R of four rows or of one row; lower triangle.
EVICAL_VECTOR_CLONES void addProductsOfFour(const double* __restrict r, Eigen::Index columns,
                                            double* __restrict sums) {
  const double *r0 = r, *r1 = r0 + columns, *r2 = r1 + columns, *r3 = r2 + columns;
  for (Eigen::Index i = 0; i < columns; ++i, sums += columns) {
    const double a0 = r0[i], a1 = r1[i], a2 = r2[i], a3 = r3[i];
    for (Eigen::Index k = 0; k <= i; ++k) sums[k] += a0 * r0[k] + a1 * r1[k] + (a2 * r2[k] + a3 * r3[k]);
  }
}
void addProductsOfOne(const double* __restrict r, Eigen::Index columns, double* __restrict sums) {
  for (Eigen::Index i = 0; i < columns; ++i, sums += columns)
    for (Eigen::Index k = 0; k <= i; ++k) sums[k] += r[i] * r[k];
}

// The same of all rows.
void lowerProducts(const double* r, Eigen::Index rows, Eigen::Index columns, std::vector<double>& products) {
  constexpr Eigen::Index kAtOnce = 4;
  products.assign(static_cast<std::size_t>(columns * columns), 0.0);
  Eigen::Index row = 0;
  for (; row + kAtOnce <= rows; row += kAtOnce)
    addProductsOfFour(r + row * columns, columns, products.data());
  for (; row < rows; ++row) addProductsOfOne(r + row * columns, columns, products.data());
}

}  // namespace

// The poses' part, from both sides, by the columns on which they depend.
void BlockJacobian::products(std::vector<double>& products) const {
  using RowMajorMatrix = ViewRows::RowMajorMatrix;
  if (rows_.chain.size() == 0) return lowerProducts(rows_.values.data(), count_, rows_.stride, products);
  std::vector<double> own;
  lowerProducts(rows_.values.data(), count_, rows_.stride, own);
  const Eigen::Index poses = rows_.poses, others = rows_.stride - poses, chained = rows_.chain.cols();
  const Eigen::Map<const RowMajorMatrix> of_rows(own.data(), rows_.stride, rows_.stride);
  products.resize(static_cast<std::size_t>((chained + others) * (chained + others)));
  Eigen::Map<RowMajorMatrix> all(products.data(), chained + others, chained + others);
  const RowMajorMatrix half =
      of_rows.topLeftCorner(poses, poses).selfadjointView<Eigen::Lower>() * rows_.chain;
  all.topLeftCorner(chained, chained).noalias() = rows_.chain.transpose() * half;
  all.bottomLeftCorner(others, chained).noalias() = of_rows.bottomLeftCorner(others, poses) * rows_.chain;
  all.bottomRightCorner(others, others) = of_rows.bottomRightCorner(others, others);
}

Eigen::MatrixXd BlockJacobian::ofOwnColumns(const Eigen::MatrixXd& of_columns) const {
  if (rows_.chain.size() == 0) return of_columns;
  Eigen::MatrixXd own(rows_.stride - 1, of_columns.cols());
  own.topRows(rows_.poses).noalias() = rows_.chain * of_columns.topRows(rows_.chain.cols());
  own.bottomRows(own.rows() - rows_.poses) = of_columns.bottomRows(own.rows() - rows_.poses);
  return own;
}

Eigen::MatrixXd BlockJacobian::pairScores() const {
  const Map rows = ownRows();
  const auto residual = residuals();
  Eigen::MatrixXd scores(count_ / 2, rows.cols());
  for (Eigen::Index i = 0; i < scores.rows(); ++i)
    scores.row(i) = residual(2 * i, 0) * rows.row(2 * i) + residual(2 * i + 1, 0) * rows.row(2 * i + 1);
  return scores;
}

Eigen::VectorXd BlockJacobian::weightedSum(const Eigen::VectorXd& weights) const {
  const Eigen::VectorXd sum = ownRows().transpose() * weights;
  if (rows_.chain.size() == 0) return sum;
  Eigen::VectorXd all(static_cast<Eigen::Index>(columnCount()));
  all << rows_.chain.transpose() * sum.head(rows_.poses), sum.tail(sum.size() - rows_.poses);
  return all;
}

void BlockJacobian::copyColumns(const Unknown& unknown, const double* by_numbers, const double* plus,
                                Eigen::Index at) {
  using RowMajorMatrix = ViewRows::RowMajorMatrix;
  const Eigen::Map<const RowMajorMatrix> numbers(by_numbers, count_, unknown.size);
  Eigen::Map<RowMajorMatrix, 0, Eigen::OuterStride<>> to(rows_.values.data() + at, count_, unknown.columns,
                                                         Eigen::OuterStride<>(rows_.stride));
  if (plus == nullptr)
    to = numbers.leftCols(unknown.columns);
  else
    to = numbers.lazyProduct(Eigen::Map<const RowMajorMatrix>(plus, unknown.size, unknown.columns));
}

double BlockJacobian::evaluateCost(std::size_t block) {
  const ceres::CostFunction& cost = columns_.cost(block);
  parameters_.clear();
  for (const std::int32_t index : columns_.unknownsOf(block))
    parameters_.push_back(columns_.unknowns()[static_cast<std::size_t>(index)].values);
  const auto count = static_cast<std::size_t>(cost.num_residuals());
  rows_.values.resize(std::max(rows_.values.size(), count));
  if (const ViewCost* const view = columns_.view(block))
    view->evaluate(parameters_.data(), {}, rows_);
  else
    cost.Evaluate(parameters_.data(), rows_.values.data(), nullptr);
  return 0.5 * Eigen::Map<const Eigen::VectorXd>(rows_.values.data(), cost.num_residuals()).squaredNorm();
}

}  // namespace evical
