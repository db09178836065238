// A simulated rig's batch from a perturbed start, with its uncertainty.
#pragma once

#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "tests/core/optimisation/simulated_rig.h"

namespace evical::test {

struct SolvedRig {
  BatchSolution solution;
  UncertaintyEstimate estimate;
};

inline SolvedRig solve(const SimulatedRig& rig, unsigned seed, const OptimisationOptions& options = {}) {
  SolvedRig solved{optimiseBatch(rig.input, disturbed(rig.truth, seed), options, RunContext{}), {}};
  solved.estimate = estimateUncertainty(rig.input, solved.solution, options, RunContext{});
  return solved;
}

}  // namespace evical::test
