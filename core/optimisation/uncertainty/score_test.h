// What is held although the recording could tell it: a gyroscope's turn against its accelerometer, a lens, and that the
// board is flat. Whether one of them is wrong is noticed by how far the estimate would step if it were free (Rao's score test),
// against that step's sigma.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/projected_information.h"

#include <string>

namespace evical {

// The options with everything free that the tests look at.
OptimisationOptions freeToBeTested(OptimisationOptions options);

// What is doubtful; empty without any. `information` is of a solution that holds what `options` hold, with it
// free all the same.
struct HeldDoubts {
  std::string gyroscopes;  // turns that are certain and larger than the rotation that is needed
  double gyroscope_sigmas = 0.0;
  std::string wandering_imus;  // that look so, but for errors that last and that no turn explains
  std::string lenses;          // that project elsewhere, for certain and by more than wrong_lens_px
  std::string board;           // that is bent, for certain and by more than bent_board_mm
  std::string shutters;        // that are said to be global, and roll
};
HeldDoubts testHeldValues(const CalibrationInput& input, const CalibrationState& state,
                          const ProjectedInformation& information, const OptimisationOptions& options);

// As if what is held were known to be what it is.
ProjectedInformation withoutHeldValues(const CalibrationInput& input, const OptimisationOptions& options,
                                       ProjectedInformation information);

}  // namespace evical
