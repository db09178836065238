#include "core/optimisation/normal_equations.h"

#include "core/base/error.h"
#include "core/base/in_parallel.h"

#include <algorithm>
#include <numeric>

namespace evical {

void NormalEquations::setZero() {
  matrix.setZero();
  gradient.setZero();
  cost = 0.0;
}

void NormalEquations::resize(const UnknownColumns& columns) {
  matrix.resize(columns.splineSize(), columns.halfBandwidth(), columns.borderSize());
  gradient.resize(columns.splineSize() + columns.borderSize());
}

PartialSums::Row PartialSums::row(Eigen::Index row) {
  if (row < end_row_)
    return {equations_.matrix.band().row(row), equations_.matrix.mixed().row(row).data(),
            &equations_.gradient[row]};
  const auto k = static_cast<std::size_t>(row - end_row_);
  const Eigen::Index mixed = halfBandwidth() + 1;
  if (beside_.size() <= k) beside_.resize(k + 1, Eigen::VectorXd::Zero(mixed + border() + 1));
  double* const numbers = beside_[k].data();
  return {numbers + halfBandwidth() - row, numbers + mixed, numbers + mixed + border()};
}

void PartialSums::add(const std::vector<Eigen::Index>& spline_columns,
                      const std::vector<Eigen::Index>& border_columns, const double* products) {
  const std::size_t splines = spline_columns.size(), all = splines + border_columns.size();
  const auto of = [&](std::size_t i, std::size_t k) { return products[i * (all + 1) + k]; };
  for (std::size_t i = 0; i < splines; ++i) {
    const Row to = row(spline_columns[i]);
    for (std::size_t k = 0; k < splines; ++k)
      if (spline_columns[k] <= spline_columns[i])
        to.band[spline_columns[k]] += of(std::max(i, k), std::min(i, k));
    for (std::size_t k = splines; k < all; ++k) to.mixed[border_columns[k - splines]] += of(k, i);
    *to.gradient += of(all, i);
  }
  for (std::size_t i = splines; i < all; ++i) {
    const Eigen::Index a = border_columns[i - splines];
    for (std::size_t k = splines; k <= i; ++k) {
      const Eigen::Index b = border_columns[k - splines];
      corner_(std::max(a, b), std::min(a, b)) += of(i, k);
    }
    border_gradient_[a] += of(all, i);
  }
  squares_ += of(all, all);
}

void PartialSums::addRest() const {
  for (std::size_t k = 0; k < beside_.size(); ++k) {
    const Eigen::Index row = end_row_ + static_cast<Eigen::Index>(k), mixed = halfBandwidth() + 1;
    const Eigen::VectorXd& numbers = beside_[k];
    double *const band = equations_.matrix.band().row(row), *const mixed_row =
                                                                equations_.matrix.mixed().row(row).data();
    for (Eigen::Index col = equations_.matrix.band().firstOf(row); col <= row; ++col)
      band[col] += numbers[halfBandwidth() + col - row];
    for (Eigen::Index col = 0; col < border(); ++col) mixed_row[col] += numbers[mixed + col];
    equations_.gradient[row] += numbers[mixed + border()];
  }
  equations_.matrix.corner() += corner_;
  equations_.gradient.tail(border()) += border_gradient_;
  equations_.cost += 0.5 * squares_;
}

void assemble(const UnknownColumns& columns, int threads, const std::stop_token& stop,
              NormalEquations& equations) {
  equations.setZero();
  const ManifoldDerivatives manifolds(columns);
  std::vector<PartialSums> sums;
  for (const UnknownColumns::Part& part : columns.parts()) sums.emplace_back(equations, part.end_row);
  inParallel(threads, sums.size(), [&](std::size_t p) {
    BlockJacobian block(columns);
    std::vector<double> products;
    const UnknownColumns::Part& part = columns.parts()[p];
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (stop.stop_requested()) throw Cancelled{};
      block.evaluate(columns.order()[i], manifolds);
      block.products(products);
      sums[p].add(block.splineColumns(), block.borderColumns(), products.data());
    }
  });
  for (const PartialSums& each : sums) each.addRest();
}

double costOf(const UnknownColumns& columns, int threads, const std::stop_token& stop) {
  std::vector<double> costs(columns.parts().size(), 0.0);
  inParallel(threads, costs.size(), [&](std::size_t p) {
    BlockJacobian block(columns);
    const UnknownColumns::Part& part = columns.parts()[p];
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (stop.stop_requested()) throw Cancelled{};
      costs[p] += block.evaluateCost(columns.order()[i]);
    }
  });
  return std::accumulate(costs.begin(), costs.end(), 0.0);
}

}  // namespace evical
