// What holds metres: the board's size, as it was measured, and gravity's norm, through the accelerometer. Both
// are unknowns with priors; what these leave open is in translations' sigmas, and where the recording
// contradicts them one of them is wrong.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/quantity_covariance.h"

#include <string>
#include <vector>

namespace evical {

struct ScaleCheck {
  std::string size_doubt;     // of the board's size, or gravity; empty without any
  std::string stretch_doubt;  // the same of its stretch
  std::string bow_doubt;      // of how far it is bent, where that is estimated
  std::vector<std::string>
      notes;  // how far a wrong measure moves each translation, and how the board is bent
};

// `covariance` is that of the solution `state`, whose priors are those of the options.
ScaleCheck checkScale(const CalibrationInput& input, const CalibrationState& state,
                      const QuantityCovariance& covariance, const OptimisationOptions& options);

// As if the board and gravity's norm were known exactly: what is left is for a longer recording, or another
// motion, to mend.
QuantityCovariance withScaleKnown(const QuantityCovariance& covariance);

}  // namespace evical
