// Split-half check: the trajectory is cut into blocks. Circles and IMU samples of every other block form one
// half, the rest the other. Each half is estimated separately, starting from the result.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"

namespace evical {

// Part of `input` in even blocks (half 0) or odd ones (1). Borders are at knots of the trajectory. Circles
// close to a border belong to neither half, so that no control point depends on only a few of them.
CalibrationInput halfOf(const CalibrationInput& input, const CalibrationState& state, double block_s,
                        int half);

// `solved`: estimate from the whole recording. If a half cannot be estimated, the result has the reason; it
// is not thrown. Throws Cancelled when asked to stop.
SplitHalfCheck checkHalves(const CalibrationInput& input, const CalibrationState& solved,
                           const OptimisationOptions& options, double block_s, const RunContext& context);

}  // namespace evical
