// What a covariance means to people: which needs it meets, and which direction is
// the weakest, in plain words.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/quantity_covariance.h"

#include <string>
#include <vector>

namespace evical {

struct Observability {
  std::vector<double> eigenvalues;      // as UncertaintyReport::observability, with the scale known
  std::vector<std::string> directions;  // of each eigenvalue, in words
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;
};

// What is asked of a sigma, in SI units.
double neededSigma(QuantityNeed need, const OptimisationOptions& options);

// What a recording can mend is judged as if the board and gravity were known (`scale_known`, as withScaleKnown
// has it); what only a better measure of the board can, against a need of its own.
Observability judgeObservability(const CalibrationInput& input, const CalibrationState& state,
                                 const QuantityCovariance& covariance, const QuantityCovariance& scale_known,
                                 const OptimisationOptions& options);

}  // namespace evical
