// A gyroscope that is turned against its accelerometer, noticed where that is not estimated: how far the
// estimate would step if the turn were free (Rao's score test), against that step's sigma.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/projected_information.h"

#include <string>

namespace evical {

// Both with the turns free, at a solution that holds them; `credible` is withoutNoise(information). What
// is doubtful of IMUs whose turn is certain and larger than the rotation that is needed; empty without any.
std::string turnedGyroscopes(const CalibrationInput& input, const ProjectedInformation& information,
                             const ProjectedInformation& credible, const OptimisationOptions& options);

// As if the turns that are not estimated were known to be what they are.
ProjectedInformation withoutLookedForRotation(const CalibrationInput& input,
                                              ProjectedInformation information);

}  // namespace evical
