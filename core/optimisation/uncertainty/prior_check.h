// Whether the recording agrees with what was said to be known: each given value and each prior
// is held against what the recording alone says, solved once more from the solution with
// everything free and without priors.
#pragma once

#include <string>
#include <vector>

namespace evical {

struct BatchSolution;
struct CalibrationInput;
struct OptimisationOptions;
struct RunContext;

struct PriorCheck {
  std::vector<std::string> notes;  // what is given, and each value that the recording contradicts
  std::string doubt;               // where that matters against the needs; empty if nowhere
};

// Without priors and with all groups free there is nothing to check, and it costs nothing.
PriorCheck checkPriors(const CalibrationInput& input, const BatchSolution& solution,
                       const OptimisationOptions& options, const RunContext& context);

}  // namespace evical
