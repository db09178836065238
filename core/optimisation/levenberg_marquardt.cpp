#include "core/optimisation/levenberg_marquardt.h"

#include "core/optimisation/unknown_columns.h"

#include <ceres/manifold.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace evical {
namespace {

constexpr double kFirstRadius = 1e12;  // weak directions (biases, gravity) need undamped steps
constexpr double kLargestRadius = 1e16, kMinRadius = 1e-32;
constexpr double kMinDiagonal = 1e-6, kLargestDiagonal = 1e32;  // of scaled columns
constexpr double kMinGain = 1e-3;  // of the predicted decrease; otherwise the step is rejected
constexpr double kGradientTolerance = 1e-12, kParameterTolerance = 1e-12;
// Consecutive invalid steps: motion that leaves directions open needs damping, found by trial.
constexpr int kMaxInvalidSteps = 20;
constexpr double kHeld = 1e30;  // times the diagonal: fixes the unknown

class Solver {
 public:
  Solver(CalibrationProblem& problem, const SolverLimits& limits, const std::stop_token& stop,
         SolverMemory& memory)
      : limits_(limits),
        stop_(stop),
        columns_(problem),
        numbers_(columns_),
        equations_(memory.equations),
        factor_(memory.factor) {
    equations_.resize(columns_);
  }

  SolverSummary run(const std::function<bool(const SolverIteration&)>& callback);

 private:
  enum class Outcome { Taken, Rejected, Invalid, Converged };

  Outcome step(SolverIteration& iteration);
  void assembleHere();
  void scaleColumns();
  Eigen::VectorXd damping() const;
  void holdAtBounds(Eigen::VectorXd& added) const;
  double gradientMaxNorm() const;

  void taken(double quality) {
    radius_ = std::min(kLargestRadius, radius_ / std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * quality - 1.0, 3)));
    shrinkage_ = 2.0;
  }
  void rejected() {
    radius_ /= shrinkage_;
    shrinkage_ *= 2.0;
  }

  const SolverLimits& limits_;
  const std::stop_token& stop_;
  UnknownColumns columns_;
  UnknownNumbers numbers_;
  NormalEquations& equations_;
  BandCholesky& factor_;
  Eigen::VectorXd at_;     // linearisation point of the equations
  Eigen::VectorXd scale_;  // of the columns, at the start
  double radius_ = kFirstRadius, shrinkage_ = 2.0;
};

void Solver::assembleHere() {
  at_ = numbers_.read();
  assemble(columns_, limits_.threads, stop_, equations_);
}

void Solver::scaleColumns() {
  scale_ = (1.0 + equations_.matrix.diagonal().array().sqrt()).inverse();
}

// Addition to the diagonal.
Eigen::VectorXd Solver::damping() const {
  const Eigen::ArrayXd scale2 = scale_.array().square();
  const Eigen::ArrayXd scaled = scale2 * equations_.matrix.diagonal().array();
  Eigen::VectorXd added = scaled.max(kMinDiagonal).min(kLargestDiagonal) / (radius_ * scale2);
  holdAtBounds(added);
  return added;
}

// Fixes unknowns at a bound that the step would cross.
void Solver::holdAtBounds(Eigen::VectorXd& added) const {
  for (const Unknown& each : columns_.unknowns()) {
    if (each.columns == 0 || each.lower.empty()) continue;
    std::vector<double> derivatives(static_cast<std::size_t>(each.size * each.columns), 0.0);
    if (each.manifold != nullptr) {
      each.manifold->PlusJacobian(each.values, derivatives.data());
    } else {
      for (int i = 0; i < each.size; ++i) derivatives[static_cast<std::size_t>(i * each.columns + i)] = 1.0;
    }
    for (int i = 0; i < each.size; ++i) {
      for (int k = 0; k < each.columns; ++k) {
        const Eigen::Index column = columns_.firstOf(each) + k;
        const double towards =
            -equations_.gradient[column] * derivatives[static_cast<std::size_t>(i * each.columns + k)];
        const auto bound = static_cast<std::size_t>(i);
        if ((each.values[i] <= each.lower[bound] && towards < 0.0) ||
            (each.values[i] >= each.upper[bound] && towards > 0.0))
          added[column] = kHeld * std::max(1.0, added[column]);
      }
    }
  }
}

// Change of the numbers by a step along the negative gradient, largest entry.
double Solver::gradientMaxNorm() const {
  numbers_.writeMoved(at_, -equations_.gradient);
  const double norm = (numbers_.read() - at_).lpNorm<Eigen::Infinity>();
  numbers_.write(at_);
  return norm;
}

Solver::Outcome Solver::step(SolverIteration& iteration) {
  const Eigen::VectorXd added = damping();
  const std::optional<Eigen::VectorXd> found = equations_.matrix.solve(added, -equations_.gradient, factor_);
  const double promised =
      found ? 0.5 * (found->dot(added.cwiseProduct(*found)) - found->dot(equations_.gradient)) : 0.0;
  if (!(promised > 0.0)) {
    radius_ *= 0.5;
    return Outcome::Invalid;
  }
  numbers_.writeMoved(at_, *found);
  // Without damping, the promise is half the step's squared length in sigmas. A short step keeps it.
  const double enough =
      std::max(0.5 * limits_.step_sigmas * limits_.step_sigmas, limits_.cost_change * equations_.cost);
  const Eigen::VectorXd moved = numbers_.read();
  iteration.step_norm = (moved - at_).norm();
  if (radius_ >= kFirstRadius && promised <= enough) {
    iteration.cost = equations_.cost - promised;
    return Outcome::Converged;
  }
  const double cost = costOf(columns_, limits_.threads, stop_), change = equations_.cost - cost;
  const bool still = iteration.step_norm <= kParameterTolerance * (at_.norm() + kParameterTolerance);
  if (still || std::abs(change) <= limits_.cost_change * equations_.cost) {
    iteration.cost = std::min(cost, equations_.cost);
    if (!(change >= 0.0)) numbers_.write(at_);
    return Outcome::Converged;
  }
  if (const double quality = change / promised; quality > kMinGain) {
    taken(quality);
    assembleHere();
    return Outcome::Taken;
  }
  numbers_.write(at_);
  rejected();
  return Outcome::Rejected;
}

SolverSummary Solver::run(const std::function<bool(const SolverIteration&)>& callback) {
  SolverSummary summary;
  assembleHere();
  scaleColumns();
  summary.initial_cost = equations_.cost;
  SolverIteration iteration{equations_.cost, gradientMaxNorm(), 0.0};
  int invalid_steps = 0;
  while (true) {
    summary.final_cost = equations_.cost;
    if (!std::isfinite(equations_.cost)) summary.failure = "the cost is not a number";
    if (invalid_steps > kMaxInvalidSteps) summary.failure = "no damping makes the normal equations solvable";
    if (!summary.failure.empty() || !callback(iteration)) return summary;
    if (summary.iterations >= limits_.max_iterations) return summary;
    summary.converged = iteration.gradient_max_norm <= kGradientTolerance || radius_ <= kMinRadius;
    if (summary.converged) return summary;
    ++summary.iterations;
    iteration.step_norm = 0.0;
    const Outcome outcome = step(iteration);
    summary.converged = outcome == Outcome::Converged;
    if (summary.converged) {
      summary.final_cost = iteration.cost;
      callback(iteration);
      return summary;
    }
    invalid_steps = outcome == Outcome::Invalid ? invalid_steps + 1 : 0;
    if (outcome == Outcome::Taken) iteration.gradient_max_norm = gradientMaxNorm();
    iteration.cost = equations_.cost;
  }
}

}  // namespace

SolverSummary solveNormalEquations(CalibrationProblem& problem, const SolverLimits& limits,
                                   const std::stop_token& stop, SolverMemory& memory,
                                   const std::function<bool(const SolverIteration&)>& callback) {
  return Solver(problem, limits, stop, memory).run(callback);
}

}  // namespace evical
