// Levenberg-Marquardt method for the batch: steps from its normal equations, whose band and border are
// factored directly, with increasing damping if they fail (K. Madsen, H. Nielsen, O. Tingleff, "Methods for
// non-linear least squares problems", 2004). Damping, acceptance and termination are those of Ceres (2.1)
// with its defaults, which tests compare with; steps are cut off at bounds.
#pragma once

#include "core/optimisation/normal_equations.h"

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

// It ends with a step of at most this length, or with a change of the cost of at most this share.
struct SolverLimits {
  int max_iterations = 0;
  double step_sigmas = 0.0;  // of all unknowns together, so that each is nearer to the optimum
  double cost_change = 0.0;
  int threads = 1;
};

struct SolverSummary {
  bool converged = false;
  std::string failure;  // empty on success
  int iterations = 0;
  double initial_cost = 0.0, final_cost = 0.0;
};

// Memory of successive solutions: tens of megabytes, which take long to get from the system.
struct SolverMemory {
  NormalEquations equations{0, 0, 0};
  BandCholesky factor{0, 0};
};

// Optimises the unknowns of a built problem. `callback` is called with the state at the start and after each
// step, accepted or not; it ends the solution by returning false. Throws Cancelled when asked to stop.
SolverSummary solveNormalEquations(CalibrationProblem& problem, const SolverLimits& limits,
                                   const std::stop_token& stop, SolverMemory& memory,
                                   const std::function<bool(const SolverIteration&)>& callback);

}  // namespace evical
