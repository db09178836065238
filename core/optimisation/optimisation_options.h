// What the batch optimisation lets people choose, in four groups; code that needs one group takes that one.
#pragma once

#include "core/optimisation/model_options.h"
#include "core/optimisation/prior_options.h"
#include "core/optimisation/solver_options.h"
#include "core/optimisation/verdict_options.h"

namespace evical {

// How far the staged release has gone.
enum class ParameterStages { Extrinsics, FurtherImus, Mappings };

struct OptimisationOptions : ModelOptions, PriorOptions, SolverOptions, VerdictOptions {
  bool operator==(const OptimisationOptions&) const = default;
};

inline ParameterStages lastStage(const ModelOptions& options) {
  return options.free_imu_intrinsics ? ParameterStages::Mappings : ParameterStages::FurtherImus;
}

}  // namespace evical
