#include "core/optimisation/solver_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kSolverFields{
    Field{"function_tolerance", &SolverOptions::function_tolerance, 1e-6, within(1e-14, 1e-2), "",
          "The last stage ends when the cost changes by less than this fraction."},
    Field{"stage_tolerance", &SolverOptions::stage_tolerance, 1e-4, within(1e-14, 1e-1), "",
          "The same for the stages before the last."},
    Field{"max_iterations", &SolverOptions::max_iterations, 30, within(1, 1000), "",
          "Iterations of one solve.", Level::Expert},
    Field{"max_rounds", &SolverOptions::max_rounds, 5, within(1, 100), "",
          "Solves of one stage, each with measurements assigned to spline segments anew."},
    Field{"segment_drift", &SolverOptions::segment_drift, 0.05, within(0.001, 0.5), "knots",
          "A time offset may move this far before measurements are assigned to spline segments anew."},
    Field{"threads", &SolverOptions::threads, 2, within(1, 256), "",
          "Threads of the batch, those of its linear algebra included.", Level::Public}};
constexpr auto kSolverDefaults = defaultsOf<SolverOptions, kSolverFields>();

}  // namespace

SolverOptions::SolverOptions() : SolverOptions(kSolverDefaults) {}

const OptionTable<SolverOptions>& SolverOptions::table() {
  static const OptionTable<SolverOptions> table(kSolverFields);
  return table;
}

}  // namespace evical
