// Contribution of the splines' own errors to the information of the quantities.
#pragma once

#include "core/base/progress.h"
#include "core/optimisation/unknown_columns.h"

#include <Eigen/Core>

namespace evical {

class BandCholesky;

// Mean contribution, by simulation and extrapolation (J. Cook, L. Stefanski, JASA 1994): further errors of
// the size that the splines already have add the same contribution again. `splines`: their factored
// information; `total`: that of the quantities at the solution's splines.
Eigen::MatrixXd informationFromNoise(const UnknownColumns& columns, const BandCholesky& splines,
                                     const Eigen::MatrixXd& total, int threads, const RunContext& context);

}  // namespace evical
