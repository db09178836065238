// What a covariance means to people: which needs it meets, and which direction is the weakest, in plain
// words.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/projected_information.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

// Covariance of all quantities in the report's coordinates: rotations about the reference IMU's axes.
struct QuantityCovariance {
  std::vector<Quantity> quantities;
  std::vector<Eigen::Index> first_column;  // of each quantity; one more for the end
  Eigen::MatrixXd covariance;
};

struct Observability {
  std::vector<double> eigenvalues;  // as UncertaintyReport::observability
  std::string weakest;
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;
};
Observability judgeObservability(const CalibrationInput& input, const CalibrationState& state,
                                 const QuantityCovariance& covariance, const OptimisationOptions& options);

}  // namespace evical
