#include "core/optimisation/block_jacobian.h"

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
  rows_ = cost.num_residuals();
  listColumns(unknowns);
  std::size_t numbers = 0;
  for (const std::int32_t index : unknowns)
    numbers += static_cast<std::size_t>(columns_.unknowns()[static_cast<std::size_t>(index)].size);
  by_numbers_.resize(std::max(by_numbers_.size(), numbers * static_cast<std::size_t>(rows_)));
  jacobians_.clear();
  double* next = by_numbers_.data();
  for (const std::int32_t index : unknowns) {
    const Unknown& unknown = columns_.unknowns()[static_cast<std::size_t>(index)];
    jacobians_.push_back(unknown.columns > 0 ? next : nullptr);
    if (unknown.columns > 0) next += rows_ * unknown.size;
  }
  residuals_.resize(static_cast<std::size_t>(rows_));
  cost.Evaluate(parameters_.data(), residuals_.data(), jacobians_.data());
  stride_ = static_cast<Eigen::Index>(spline_columns_.size() + border_columns_.size()) + 1;
  values_.resize(std::max(values_.size(), static_cast<std::size_t>(rows_ * stride_)));
  Eigen::Index spline_at = 0, border_at = splineCount();
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (jacobians_[i] == nullptr) continue;
    const auto index = static_cast<std::size_t>(unknowns[i]);
    const Unknown& unknown = columns_.unknowns()[index];
    Eigen::Index& at = unknown.spline ? spline_at : border_at;
    copyColumns(unknown, jacobians_[i], unknown.leading ? nullptr : manifolds.of(index), at);
    at += unknown.columns;
  }
  for (Eigen::Index row = 0; row < rows_; ++row)
    values_[static_cast<std::size_t>(row * stride_ + stride_ - 1)] =
        residuals_[static_cast<std::size_t>(row)];
}

namespace {

template <int Columns>
void copyRows(const double* from, Eigen::Index from_stride, Eigen::Index rows, double* to,
              Eigen::Index to_stride) {
  for (Eigen::Index row = 0; row < rows; ++row, from += from_stride, to += to_stride)
    for (int k = 0; k < Columns; ++k) to[k] = from[k];
}

}  // namespace

void BlockJacobian::copyColumns(const Unknown& unknown, const double* by_numbers, const double* plus,
                                Eigen::Index at) {
  double* const to = values_.data() + at;
  if (plus == nullptr) {
    if (unknown.columns == 1)
      copyRows<1>(by_numbers, unknown.size, rows_, to, stride_);
    else if (unknown.columns == 3)
      copyRows<3>(by_numbers, unknown.size, rows_, to, stride_);
    else
      for (int k = 0; k < unknown.columns; ++k)
        copyRows<1>(by_numbers + k, unknown.size, rows_, to + k, stride_);
    return;
  }
  const Eigen::Map<const RowMajorMatrix> numbers(by_numbers, rows_, unknown.size),
      derivative(plus, unknown.size, unknown.columns);
  Eigen::Map<RowMajorMatrix, 0, Eigen::OuterStride<>>(
      to, rows_, unknown.columns, Eigen::OuterStride<>(stride_)) = numbers.lazyProduct(derivative);
}

double BlockJacobian::evaluateCost(std::size_t block) {
  const ceres::CostFunction& cost = columns_.cost(block);
  parameters_.clear();
  for (const std::int32_t index : columns_.unknownsOf(block))
    parameters_.push_back(columns_.unknowns()[static_cast<std::size_t>(index)].values);
  residuals_.resize(static_cast<std::size_t>(cost.num_residuals()));
  cost.Evaluate(parameters_.data(), residuals_.data(), nullptr);
  double squares = 0.0;
  for (const double residual : residuals_) squares += residual * residual;
  return 0.5 * squares;
}

}  // namespace evical
