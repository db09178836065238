// Check of the metric scale: it follows from the measured board size, and from gravity's norm by the
// accelerometer. Both are unknowns with priors. The sigmas of translations include them. If the recording
// contradicts the priors, one of them is wrong.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/quantity_covariance.h"

#include <string>
#include <vector>

namespace evical {

struct ScaleCheck {
  std::string size_doubt;          // of the board's size, or gravity; empty without any
  std::string stretch_doubt;       // the same of its stretch
  std::string bow_doubt;           // of an estimated bow
  std::vector<std::string> notes;  // effect of a wrong board size on each translation, and the board's bow
};

// `covariance` is that of the solution `state`, whose priors are those of the options.
ScaleCheck checkScale(const CalibrationInput& input, const CalibrationState& state,
                      const QuantityCovariance& covariance, const OptimisationOptions& options);

// Covariance with the board and gravity's norm known exactly: the part that a longer recording, or another
// motion, can reduce.
QuantityCovariance withScaleKnown(const QuantityCovariance& covariance);

}  // namespace evical
