// Batch optimisation of everything at once (docs/maths.md, 9): splines, cameras, IMUs and gravity against
// every circle and every IMU sample. Staged release: (1) splines, gravity, cameras, biases; (2) further IMUs;
// (3) scale and misalignment. Free camera intrinsics are released in the last of them.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/weights.h"

#include <string>
#include <vector>

namespace evical {

struct BatchSolution {
  CalibrationState state;
  std::vector<CameraFit> cameras;  // normalised_rms: against the front end's own covariances
  std::vector<ImuFit> imus;
  std::vector<IterationRecord> iterations;
  std::vector<std::string> notes;
  bool converged = false;
  NoiseScales scales;
  CircleSelection used_circles;  // that took part
  std::vector<SampleSelection> used_samples;
};

// Input: a camera and an IMU, or two cameras, all with their intrinsics. `initial` lists them all and gives
// the splines' range and knots: both cover the views with a margin for the time offset to move. Throws
// CalibrationError when nothing can be solved, and Cancelled when asked to stop.
BatchSolution optimiseBatch(const CalibrationInput& input, const CalibrationState& initial,
                            const OptimisationOptions& options, const RunContext& context);

// From a state that is a solution already, of these or of similar data: the last
// stage only, which nobody observes.
BatchSolution refineBatch(const CalibrationInput& input, const CalibrationState& solved,
                          const OptimisationOptions& options, const RunContext& context);

}  // namespace evical
