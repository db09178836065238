// Options of the batch optimisation's solver.
#pragma once

#include "core/base/option_struct.h"

namespace evical {

struct SolverOptions {
  double last_step_sigmas;
  double stage_tolerance;
  int max_iterations;
  int max_rounds;
  double segment_drift;
  int threads;

  SolverOptions();  // the defaults
  constexpr explicit SolverOptions(NoDefaults) {}
  bool operator==(const SolverOptions&) const = default;
  static const OptionTable<SolverOptions>& table();
};

}  // namespace evical
