// How far a solution is from what was measured, in units of what was given for it. Sigmas follow what is found, but
// they do not tell of what the model leaves out: a misfit is a sign of it, and part of the verdict.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/batch_optimiser.h"

#include <string>
#include <vector>

namespace evical {

struct MisfitVerdict {
  std::string failure;  // beyond the larger bounds: what comes out of this is no result
  std::string doubt;    // beyond the smaller ones
};
MisfitVerdict judgeMisfit(const CalibrationInput& input, const BatchSolution& solution,
                          const VerdictOptions& options);

// Where the halves of a recording are further apart than their sigmas allow; empty where they are not.
std::string doubtOfHalves(const SplitHalfCheck& validation, const VerdictOptions& options);

// IMUs that were at a limit for long; empty without any. No doubt of its own, but the cause of most others.
std::string saturationIn(const CalibrationInput& input, const VerdictOptions& options);

// Event cameras whose pixels tell of brightening and of darkening edges with different delays: a note for each.
std::vector<std::string> notesOnSlowPixels(const CalibrationInput& input, const VerdictOptions& options);

// The misfits of all sensors as one number, 0 where none exceeds what was given: for comparing explanations.
double totalMisfit(const BatchSolution& solution);

}  // namespace evical
