// A cost function's Jacobians against central differences, quaternion blocks perturbed on the right.
#pragma once

#include "core/optimisation/calibration_problem.h"
#include "tests/support/numeric_jacobian.h"

#include <ceres/cost_function.h>

#include <vector>

namespace evical::test {

using Blocks = std::vector<std::vector<double>>;

inline bool isQuaternion(const std::vector<double>& block) {
  return block.size() == 4;
}

inline Eigen::VectorXd residualsAt(const ceres::CostFunction& cost, const Blocks& blocks) {
  std::vector<const double*> pointers;
  for (const auto& block : blocks) pointers.push_back(block.data());
  Eigen::VectorXd residuals(cost.num_residuals());
  cost.Evaluate(pointers.data(), residuals.data(), nullptr);
  return residuals;
}

// Largest relative difference over all blocks.
inline double worstJacobianError(const ceres::CostFunction& cost, const Blocks& blocks, double step = 1e-4) {
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<RowMajorMatrix> analytic;
  std::vector<const double*> pointers;
  std::vector<double*> jacobians;
  for (const auto& block : blocks) {
    analytic.emplace_back(
        RowMajorMatrix::Constant(cost.num_residuals(), static_cast<Eigen::Index>(block.size()), 1e9));
    pointers.push_back(block.data());
  }
  for (auto& jacobian : analytic) jacobians.push_back(jacobian.data());
  Eigen::VectorXd residuals(cost.num_residuals());
  cost.Evaluate(pointers.data(), residuals.data(), jacobians.data());
  double worst = (residuals - residualsAt(cost, blocks)).norm();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Eigen::Index size = isQuaternion(blocks[i]) ? 3 : static_cast<Eigen::Index>(blocks[i].size());
    const auto moved = [&](const Eigen::VectorXd& delta) -> Eigen::VectorXd {
      Blocks at = blocks;
      if (isQuaternion(blocks[i])) {
        So3Manifold().Plus(blocks[i].data(), delta.data(), at[i].data());
      } else {
        for (Eigen::Index k = 0; k < size; ++k) at[i][static_cast<std::size_t>(k)] += delta[k];
      }
      return residualsAt(cost, at);
    };
    // Time offsets are single numbers with a large effect per step.
    const double own_step = size == 1 ? 0.1 * step : step;
    const Eigen::MatrixXd numeric = numericJacobian(moved, size, own_step);
    worst = std::max(worst, relativeDifference(analytic[i].leftCols(size), numeric));
    if (isQuaternion(blocks[i])) worst = std::max(worst, analytic[i].col(3).cwiseAbs().maxCoeff());
  }
  return worst;
}

// The largest over evaluations with one block at a time constant, as Ceres requests them.
inline double worstErrorWithConstantBlocks(const ceres::CostFunction& cost, const Blocks& blocks) {
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<const double*> pointers;
  for (const auto& block : blocks) pointers.push_back(block.data());
  const auto evaluate = [&](std::size_t constant) {
    std::vector<RowMajorMatrix> all;
    std::vector<double*> jacobians;
    for (const auto& block : blocks) {
      all.emplace_back(RowMajorMatrix::Zero(cost.num_residuals(), static_cast<Eigen::Index>(block.size())));
    }
    for (std::size_t i = 0; i < all.size(); ++i) jacobians.push_back(i == constant ? nullptr : all[i].data());
    Eigen::VectorXd residuals(cost.num_residuals());
    cost.Evaluate(pointers.data(), residuals.data(), jacobians.data());
    return all;
  };
  const auto reference = evaluate(blocks.size());
  double worst = 0.0;
  for (std::size_t constant = 0; constant < blocks.size(); ++constant) {
    const auto some = evaluate(constant);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (i != constant) worst = std::max(worst, (some[i] - reference[i]).cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

}  // namespace evical::test
