#include "core/optimisation/uncertainty/block_scores.h"

#include "core/optimisation/normal_equations.h"

#include <algorithm>

namespace evical {

// Searches first for the columns that were added last.
Eigen::Index LocalSums::localOf(const Column& column) {
  const auto found = std::find(columns_.rbegin(), columns_.rend(), column);
  if (found != columns_.rend()) return static_cast<Eigen::Index>(columns_.rend() - found) - 1;
  columns_.push_back(column);
  const Eigen::Index count = columnCount();
  if (count > products_.rows()) {
    const Eigen::Index room = std::max<Eigen::Index>(64, 2 * count);
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(room, room);
    products.topLeftCorner(products_.rows(), products_.cols()) = products_;
    products_ = std::move(products);
    gradient_.conservativeResizeLike(Eigen::VectorXd::Zero(room));
    with_errors_.conservativeResizeLike(Eigen::VectorXd::Zero(room));
  }
  return count - 1;
}

void LocalSums::addClusters(const BlockJacobian& block, const std::vector<Eigen::Index>& local,
                            const std::vector<std::array<ResidualCluster, 2>>& clusters) {
  const Eigen::Index stride = block.stride();
  const double* row = block.data();
  for (const std::array<ResidualCluster, 2>& of_circle : clusters) {
    const double x = row[stride - 1], y = row[2 * stride - 1];
    for (const ResidualCluster& cluster : of_circle) {
      const auto found = std::ranges::find(clusters_, cluster);
      const auto at = static_cast<std::size_t>(found - clusters_.begin());
      if (found == clusters_.end()) {
        clusters_.push_back(cluster);
        by_cluster_.emplace_back(Eigen::VectorXd::Zero(products_.rows()));
      }
      Eigen::VectorXd& sum = by_cluster_[at];
      if (sum.size() < products_.rows()) sum.conservativeResizeLike(Eigen::VectorXd::Zero(products_.rows()));
      for (std::size_t i = 0; i < local.size(); ++i)
        sum[local[i]] += x * row[i] + y * row[static_cast<std::size_t>(stride) + i];
    }
    row += 2 * stride;
  }
}

void LocalSums::add(const BlockJacobian& block, const Eigen::VectorXd& pixel_errors,
                    const std::vector<std::array<ResidualCluster, 2>>& clusters) {
  std::vector<Eigen::Index> local;
  for (const Eigen::Index column : block.splineColumns()) local.push_back(localOf({true, column}));
  for (const Eigen::Index column : block.borderColumns()) local.push_back(localOf({false, column}));
  lowerProducts(block.data(), block.rows(), block.stride(), of_block_);
  const double* row = of_block_.data();
  for (std::size_t i = 0; i < local.size(); ++i, row += block.stride())
    for (std::size_t k = 0; k <= i; ++k)
      products_(std::max(local[i], local[k]), std::min(local[i], local[k])) += row[k];
  for (std::size_t i = 0; i < local.size(); ++i) gradient_[local[i]] += row[i];
  squared_residuals_ += row[local.size()];
  addClusters(block, local, clusters);
  if (pixel_errors.size() == 0) return;
  has_errors_ = true;
  const double* of_residual = block.data();
  for (Eigen::Index k = 0; k < block.rows(); ++k, of_residual += block.stride())
    for (std::size_t i = 0; i < local.size(); ++i) with_errors_[local[i]] += pixel_errors[k] * of_residual[i];
}

ProjectedSums LocalSums::projected(const UnknownColumns& columns,
                                   const SplineElimination& elimination) const {
  const Eigen::Index count = columnCount();
  Eigen::MatrixXd by_quantities = Eigen::MatrixXd::Zero(count, elimination.quantities());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Column& column = columns_[static_cast<std::size_t>(i)];
    if (column.spline)
      by_quantities.row(i) = elimination.ofSpline(column.index);
    else if (column.index < columns.quantitySize())
      by_quantities(i, column.index) = 1.0;
    else
      by_quantities.row(i) = elimination.ofKnot(column.index - columns.quantitySize());
  }
  const Eigen::MatrixXd products = products_.topLeftCorner(count, count).selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd mixed = products * by_quantities;
  ProjectedSums sums;
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(mixed.cols(), mixed.cols());
  lower.triangularView<Eigen::Lower>() = by_quantities.transpose() * mixed;
  sums.information = lower.selfadjointView<Eigen::Lower>();  // to the last digit
  sums.score.noalias() = by_quantities.transpose() * gradient_.head(count);
  sums.squared_residuals = squared_residuals_;
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    const Eigen::Index known = std::min(count, by_cluster_[k].size());
    sums.clusters.emplace_back(clusters_[k],
                               by_quantities.topRows(known).transpose() * by_cluster_[k].head(known));
  }
  if (has_errors_) sums.pixel_errors.noalias() = by_quantities.transpose() * with_errors_.head(count);
  return sums;
}

}  // namespace evical
