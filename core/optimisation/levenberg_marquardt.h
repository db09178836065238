// Levenberg and Marquardt's method on the batch: steps from its normal equations, whose band and border are factored
// directly, damped as far as they fail (K. Madsen, H. Nielsen, O. Tingleff, "Methods for non-linear least squares
// problems", 2004). Damping, what counts as a good step and when it ends are as in Ceres (2.1) with its defaults, which
// tests compare with; bounds are kept by cutting steps off at them.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

namespace evical {

class CalibrationProblem;

struct SolverIteration {
  double cost = 0.0;
  double gradient_max_norm = 0.0;
  double step_norm = 0.0;
};

struct SolverLimits {
  int most_iterations = 0;
  double function_tolerance = 0.0;  // it ends when the cost changes by less than this fraction
  int threads = 1;
};

struct SolverEnd {
  bool converged = false;
  std::string failure;  // empty without one
  int iterations = 0;
  double first_cost = 0.0, last_cost = 0.0;
};

// Moves the unknowns of a problem that is built. `after` is called with the state that was there at the start, and after
// each step, taken or not; it ends the solution by returning false. Throws Cancelled when asked to stop.
SolverEnd solveNormalEquations(CalibrationProblem& problem, const SolverLimits& limits,
                               const std::stop_token& stop,
                               const std::function<bool(const SolverIteration&)>& after);

}  // namespace evical
