// Score test of fixed quantities that the recording could determine: a gyroscope's misalignment, a lens, and
// the flatness of the board. The step of the estimate if it were free is compared with the step's sigma
// (Rao's score test).
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/projected_information.h"

#include <string>

namespace evical {

// The options with all tested quantities free.
OptimisationOptions freeToBeTested(OptimisationOptions options);

// Doubts; empty without any. `information` is of a solution in which the quantities that `options` fix are
// fixed, but are free columns.
struct HeldDoubts {
  std::string gyroscopes;  // significant misalignments above needed_rotation_deg
  double gyroscope_sigmas = 0.0;
  std::string wandering_imus;  // seemingly misaligned, but with lasting errors that this does not explain
  std::string lenses;          // significant projection errors above wrong_lens_px
  std::string board;           // significant bow above bent_board_mm
  std::string shutters;        // declared global, but rolling
};
HeldDoubts testHeldValues(const CalibrationInput& input, const CalibrationState& state,
                          const ProjectedInformation& information, const OptimisationOptions& options);

// The information if all fixed values are exact.
ProjectedInformation withoutHeldValues(const CalibrationInput& input, const OptimisationOptions& options,
                                       ProjectedInformation information);

}  // namespace evical
