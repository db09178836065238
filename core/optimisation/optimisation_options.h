// Options of the batch optimisation, in four groups; code that needs one group takes only that group.
#pragma once

#include "core/optimisation/model_options.h"
#include "core/optimisation/prior_options.h"
#include "core/optimisation/solver_options.h"
#include "core/optimisation/verdict_options.h"

namespace evical {

// Stages of the release of parameters.
enum class ParameterStages { Extrinsics, FurtherImus, Mappings };

struct OptimisationOptions : ModelOptions, PriorOptions, SolverOptions, VerdictOptions {
  bool operator==(const OptimisationOptions&) const = default;
};

inline ParameterStages lastStage(const ModelOptions& options) {
  return options.free_imu_intrinsics ? ParameterStages::Mappings : ParameterStages::FurtherImus;
}

}  // namespace evical
