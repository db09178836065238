#include "core/optimisation/solver_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kSolverFields{
    Field{"last_step_sigmas", &SolverOptions::last_step_sigmas, 0.5, within(1e-6, 10.0), "sigmas",
          "Length of the last stage's last step, over all unknowns. The optimum is more than ten times "
          "nearer."},
    Field{"stage_tolerance", &SolverOptions::stage_tolerance, 1e-4, within(1e-14, 1e-1), "",
          "Relative cost change at which a stage before the last ends."},
    Field{"max_iterations", &SolverOptions::max_iterations, 30, within(1, 1000), "", "Iterations per solve.",
          Level::Expert},
    Field{"max_rounds", &SolverOptions::max_rounds, 5, within(1, 100), "",
          "Solves per stage; measurements are assigned to spline segments again before each."},
    Field{"segment_drift", &SolverOptions::segment_drift, 0.05, within(0.001, 0.5), "knots",
          "Time offset change after which measurements are assigned to spline segments again."},
    Field{"threads", &SolverOptions::threads, 2, within(1, 256), "",
          "Threads of the batch, including its linear algebra.", Level::Public}};
constexpr auto kSolverDefaults = defaultsOf<SolverOptions, kSolverFields>();

}  // namespace

SolverOptions::SolverOptions() : SolverOptions(kSolverDefaults) {}

const OptionTable<SolverOptions>& SolverOptions::table() {
  static const OptionTable<SolverOptions> table(kSolverFields);
  return table;
}

}  // namespace evical
