// Covariance of all quantities in the report's coordinates: rotations about the reference IMU's axes, gravity
// by its two tilts.
#pragma once

#include "core/geometry/so3.h"
#include "core/optimisation/parameter_blocks.h"

#include <Eigen/Core>

#include <vector>

namespace ceres {
class Problem;
}

namespace evical {

struct ProjectedInformation;

struct QuantityCovariance {
  std::vector<Quantity> quantities;
  std::vector<Eigen::Index> first_column;  // of each quantity; one more for the end
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd as_weighed =
      {};  // had all errors the size that they are weighed with, and none hung together
};

// From tangent space as Ceres has it to the report's coordinates.
Eigen::MatrixXd reportFromTangent(const ProjectedInformation& information, const CalibrationState& state,
                                  ceres::Problem& problem);

QuantityCovariance quantityCovariance(const ProjectedInformation& information,
                                      const Eigen::MatrixXd& report_from_tangent);

// All events of a camera are late by the delay of its pixels, which the recording does not determine: this
// adds to the uncertainty of its time offset, and more if the delays of the two polarities differ. Not added
// if such pixels measure everything (holdsPixelDelay).
QuantityCovariance withPixelDelay(const CalibrationInput& input, const OptimisationOptions& options,
                                  QuantityCovariance covariance);

}  // namespace evical
