// Uncertainty of drifting biases at their knots.
#pragma once

#include "core/data/calibration_result.h"
#include "core/optimisation/uncertainty/projected_information.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

// Fills the drifts' sigmas of the report's IMUs. `covariance`: of the information's quantities, in their
// tangent spaces, the biases' means among them.
void reportDrift(const ProjectedInformation& information, const std::vector<Quantity>& drift_blocks,
                 const Eigen::MatrixXd& covariance, UncertaintyReport& report);

}  // namespace evical
