// Residuals of a solution relative to their expected size. Sigmas are scaled by the residuals, but do not
// include errors of the model. A misfit indicates such errors and is part of the verdict.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/quality_warning.h"
#include "core/data/recording.h"
#include "core/optimisation/batch_optimiser.h"

#include <string>
#include <vector>

namespace evical {

struct MisfitVerdict {
  std::string failure;  // beyond the larger bounds: the estimate is not usable
  std::string doubt;    // beyond the smaller ones
};
MisfitVerdict judgeMisfit(const CalibrationInput& input, const BatchSolution& solution,
                          const VerdictOptions& options);

// Reason for doubt if the halves of a recording differ by more than their sigmas allow; otherwise empty.
std::string doubtOfHalves(const SplitHalfCheck& validation, const VerdictOptions& options);

// Scattering stamps of IMUs whose residuals are larger than their noise; empty if none. Not a separate
// doubt, but the cause of most others, such as large sigmas.
std::string scatteringStampsIn(const CalibrationInput& input, const BatchSolution& solution,
                               const std::vector<RecordingFault>& faults, const VerdictOptions& options);

// Adds half a step of coarse IMU stamps in squares to the sigmas of time offsets (docs/maths.md, 10.1):
// rounding is the same in all samples, and in no residual. Flags the result if that is more than time offsets
// may be uncertain by. `steps_s`: by IMU, or empty.
void addStampErrors(const CalibrationInput& input, const std::vector<double>& steps_s,
                    const VerdictOptions& options, CalibrationResult& result);

// IMUs that were saturated for long; empty if none. Not a separate doubt, but the cause of most others, and
// of all if a large part of the samples is missing.
QualityWarning saturationIn(const CalibrationInput& input, const VerdictOptions& options, double heavy_share);

// A note for each event camera whose ON and OFF events have different delays.
std::vector<std::string> notesOnSlowPixels(const CalibrationInput& input, const VerdictOptions& options);

// Misfits of all sensors as one number, 0 if none exceeds its expected size. Compares explanations.
double totalMisfit(const BatchSolution& solution);

}  // namespace evical
