// Batch optimisation of all parameters at once (docs/maths.md, 9): splines, cameras, IMUs and gravity, with
// all circles and IMU samples as measurements. Staged release: (1) splines, gravity, cameras, biases;
// (2) further IMUs; (3) scale and misalignment, and free camera intrinsics.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/circle_errors.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/weights.h"

#include <string>
#include <vector>

namespace evical {

struct BatchSolution {
  CalibrationState state;
  std::vector<CameraFit> cameras;  // normalised_rms: by the front end's covariances
  std::vector<ImuFit> imus;
  std::vector<IterationRecord> iterations;
  std::vector<std::string> notes;
  bool converged = false;
  NoiseScales scales;
  CircleSelection used_circles;  // used in the last solve
  std::vector<SampleSelection> used_samples;
  std::vector<CircleError> circle_errors;  // of all circles within the splines' range
};

// Input: a camera and an IMU, or two cameras, all with intrinsics. `initial` lists them all and gives the
// splines' range and knots, which cover the views plus a margin for changes of the time offset. Throws
// CalibrationError if nothing can be solved, and Cancelled when asked to stop.
BatchSolution optimiseBatch(const CalibrationInput& input, const CalibrationState& initial,
                            const OptimisationOptions& options, const RunContext& context);

// Solves only the last stage, with other options or slightly other data, from a solution; its iterations
// follow those before. Not from a solution with wrong inputs: parameters that are freed may end in another
// optimum.
BatchSolution continueBatch(const CalibrationInput& input, const CalibrationState& solved,
                            std::vector<IterationRecord> before, const OptimisationOptions& options,
                            const RunContext& context);

// Solves only the last stage, unobserved, from a state that is already a solution for these or similar data.
// Its weights are determined once, at that state, so the solution has no fits, notes or errors of circles.
BatchSolution refineBatch(const CalibrationInput& input, const CalibrationState& solved,
                          const OptimisationOptions& options, const RunContext& context);

// The same for a trial of other options: loosely solved, with scales at its solution, where residuals may be
// much smaller.
BatchSolution tryBatch(const CalibrationInput& input, const CalibrationState& solved,
                       const OptimisationOptions& options, const RunContext& context);

}  // namespace evical
