// Check of priors: each given value and each prior is compared with the recording alone, by another
// solution that starts at the current one with everything free and without priors.
#pragma once

#include <string>
#include <vector>

namespace evical {

struct BatchSolution;
struct CalibrationInput;
struct OptimisationOptions;
struct RunContext;

struct PriorCheck {
  std::vector<std::string> notes;  // given values, and contradicted ones
  std::string doubt;               // relevant contradictions; empty if none
};

// Returns at once if there are no priors and all groups are free.
PriorCheck checkPriors(const CalibrationInput& input, const BatchSolution& solution,
                       const OptimisationOptions& options, const RunContext& context);

}  // namespace evical
