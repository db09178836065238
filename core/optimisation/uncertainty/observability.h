// Interpretation of a covariance for people: which needs it meets, and its weakest
// direction.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/quantity_covariance.h"

#include <string>
#include <vector>

namespace evical {

struct Observability {
  std::vector<double> eigenvalues;      // as UncertaintyReport::observability, for a known scale
  std::vector<std::string> directions;  // text for each eigenvalue
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;
};

// Needed sigma, in SI units.
double neededSigma(QuantityNeed need, const OptimisationOptions& options);

// Needs that another recording can meet are compared with the sigmas for a known board and gravity
// (`scale_known`, from withScaleKnown). Needs that only a better board measurement can meet are compared
// separately.
Observability judgeObservability(const CalibrationInput& input, const CalibrationState& state,
                                 const QuantityCovariance& covariance, const QuantityCovariance& scale_known,
                                 const OptimisationOptions& options);

}  // namespace evical
