// Do two halves of a recording say the same? The trajectory is cut into blocks; circles and IMU samples of
// every other block make one half, the rest the other. Each is estimated by itself, starting from the result.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"

namespace evical {

// The part of `input` in even blocks (half 0), or in odd ones (1). Borders lie on knots of the trajectory, and circles
// close to one belong to neither half, so that no control point hangs on a few of them.
CalibrationInput halfOf(const CalibrationInput& input, const CalibrationState& state, double block_s,
                        int half);

// `solved` is the estimate from the whole. Never throws for a half that can't be estimated: the result says
// so. Throws Cancelled when asked to stop.
SplitHalfCheck checkHalves(const CalibrationInput& input, const CalibrationState& solved,
                           const OptimisationOptions& options, double block_s, const RunContext& context);

}  // namespace evical
