// J^T J and J^T r of a few residual blocks near in time, in those columns only that they have to do with, until they are
// projected: cheaper by far than projecting each of their rows.
#pragma once

#include "core/optimisation/block_jacobian.h"
#include "core/optimisation/uncertainty/spline_elimination.h"

#include <Eigen/Core>

#include <array>
#include <tuple>
#include <utility>
#include <vector>

namespace evical {

// Circles whose errors may have a part in common: those of one point of the board, or of one place in the image.
struct ResidualCluster {
  enum class Kind { Point, Place } kind = Kind::Point;
  int index = 0;
  bool operator==(const ResidualCluster&) const = default;
  bool operator<(const ResidualCluster& other) const {
    return std::tie(kind, index) < std::tie(other.kind, other.index);
  }
};

// [P r]^T [P r]: information, score and squared residuals.
struct ProjectedSums {
  std::vector<std::pair<ResidualCluster, Eigen::VectorXd>> clusters;  // P^T r of each
  Eigen::MatrixXd information;
  Eigen::VectorXd score;
  double squared_residuals = 0.0;
  Eigen::VectorXd pixel_errors;  // P^T d; empty without any
};

class LocalSums {
 public:
  // `pixel_errors`: d, by residual; empty if absent. `clusters`: of each pair of residuals; empty if absent.
  void add(const BlockJacobian& block, const Eigen::VectorXd& pixel_errors,
           const std::vector<std::array<ResidualCluster, 2>>& clusters);
  Eigen::Index columnCount() const { return static_cast<Eigen::Index>(columns_.size()); }

  ProjectedSums projected(const UnknownColumns& columns, const SplineElimination& elimination) const;

 private:
  struct Column {
    bool spline;
    Eigen::Index index;
    bool operator==(const Column&) const = default;
  };

  Eigen::Index localOf(const Column& column);
  void addClusters(const BlockJacobian& block, const std::vector<Eigen::Index>& local,
                   const std::vector<std::array<ResidualCluster, 2>>& clusters);

  std::vector<Column> columns_;
  Eigen::MatrixXd products_;                // lower triangle; at least as large as there are columns
  Eigen::VectorXd gradient_, with_errors_;  // J^T r, J^T d
  double squared_residuals_ = 0.0;
  bool has_errors_ = false;
  std::vector<double> of_block_;
  std::vector<ResidualCluster> clusters_;
  std::vector<Eigen::VectorXd> by_cluster_;  // J^T r of each
};

}  // namespace evical
