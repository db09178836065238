#include "core/numerics/change_test.h"

#include "core/numerics/chi_squared.h"
#include "core/numerics/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace evical {
namespace {

constexpr double kNoInformation = 1e-9;  // relative to the prior information
constexpr double kFreed = 1e8;           // factor on the variance

void setFree(const StateBlock& block, Eigen::MatrixXd& covariance) {
  for (Eigen::Index i = block.first; i < block.first + block.size; ++i)
    covariance(i, i) += kFreed * covariance(i, i);
}

}  // namespace

// A step s in the data: v ~ N(H s, H + H P H), so that its weight is H (H + H P H)^-1 H, which is
// P^-1 - P^-1 (P^-1 + H)^-1 P^-1 even if H is singular.
ChangeDetector::ChangeDetector(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                               const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd scale = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::MatrixXd h = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::MatrixXd p =
      scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd v = scale.cwiseProduct(score);
  // (P^-1 + H)^-1 = P (I + H P)^-1
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(h.rows(), h.cols());
  const Eigen::PartialPivLU<Eigen::MatrixXd> solver(identity + h * p);
  Eigen::MatrixXd weight = solver.solve(h);
  weight = (0.5 * (weight + weight.transpose())).eval();
  const Eigen::VectorXd back = scale.cwiseInverse();
  weight_ = back.asDiagonal() * weight * back.asDiagonal();
  pull_ = back.cwiseProduct(solver.solve(v));
}

ChangeDetector::ChangeDetector(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance)
    : weight_(inverseOf(covariance)), pull_(weight_ * difference), regular_(true) {}

BlockChange ChangeDetector::of(const StateBlock& block) const {
  const Eigen::MatrixXd weight = weight_.block(block.first, block.first, block.size, block.size);
  const Eigen::VectorXd pull = pull_.segment(block.first, block.size);
  if (regular_) {
    const Eigen::MatrixXd covariance = inverseOf(weight);
    const Eigen::VectorXd step = covariance * pull;
    return {step, covariance, step.dot(pull), block.size};
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(weight);
  const double least = std::max(kNoInformation * eigen.eigenvalues().maxCoeff(), 1e-300);
  BlockChange change;
  change.step = Eigen::VectorXd::Zero(block.size);
  change.covariance = Eigen::MatrixXd::Zero(block.size, block.size);
  for (Eigen::Index i = 0; i < block.size; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (!(value > least)) continue;
    const Eigen::VectorXd axis = eigen.eigenvectors().col(i);
    const double along = axis.dot(pull);
    change.step += axis * along / value;
    change.covariance += axis * axis.transpose() / value;
    change.chi_square += along * along / value;
    ++change.rank;
  }
  return change;
}

double ChangeDetector::worstSigma(const StateBlock& block) const {
  const Eigen::MatrixXd weight = weight_.block(block.first, block.first, block.size, block.size);
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(weight).eigenvalues().minCoeff();
  return least > 0.0 ? 1.0 / std::sqrt(least) : std::numeric_limits<double>::infinity();
}

std::vector<double> limitsFor(std::span<const StateBlock> blocks, double false_alarm_probability) {
  std::vector<double> limits;
  for (const StateBlock& block : blocks)
    limits.push_back(chiSquaredLimit(false_alarm_probability, static_cast<int>(block.size)));
  return limits;
}

std::vector<FoundChange> findChanges(
    std::size_t blocks, const std::function<std::vector<double>(const std::vector<bool>& free)>& beyond) {
  constexpr double kNearly = 9.0;  // three sigmas
  std::vector<FoundChange> found;
  std::vector<bool> free(blocks, false);
  for (;;) {
    std::vector<double> excess = beyond(free);
    for (std::size_t b = 0; b < blocks; ++b)
      if (free[b]) excess[b] = -std::numeric_limits<double>::infinity();
    const auto best =
        static_cast<std::size_t>(std::max_element(excess.begin(), excess.end()) - excess.begin());
    if (best == blocks || !(excess[best] > 0.0)) return found;
    FoundChange& each = found.emplace_back();
    each.block = best;
    for (std::size_t b = 0; b < blocks; ++b)
      if (b != best && excess[b] > 0.0 && excess[b] > excess[best] - kNearly) each.alternatives.push_back(b);
    free[best] = true;
  }
}

std::vector<FoundChange> findChanges(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                                     const Eigen::MatrixXd& covariance, std::span<const StateBlock> blocks,
                                     std::span<const double> limits) {
  std::vector<BlockChange> changes(blocks.size());  // latest test of each, before it was freed
  std::vector<FoundChange> found = findChanges(blocks.size(), [&](const std::vector<bool>& free) {
    Eigen::MatrixXd known = covariance;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (free[b]) setFree(blocks[b], known);
    const ChangeDetector test(information, score, known);
    std::vector<double> beyond(blocks.size(), 0.0);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (free[b]) continue;
      changes[b] = test.of(blocks[b]);
      beyond[b] = changes[b].chi_square - limits[b];
    }
    return beyond;
  });
  for (FoundChange& each : found) each.change = changes[each.block];
  return found;
}

double smallestDetectable(double worst_sigma, double limit) {
  constexpr double kNinetyFivePercent = 1.645;
  return (std::sqrt(limit) + kNinetyFivePercent) * worst_sigma;
}

}  // namespace evical
