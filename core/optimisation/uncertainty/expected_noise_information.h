// What the splines' own errors add to the information of the quantities.
#pragma once

#include "core/base/progress.h"
#include "core/optimisation/unknown_columns.h"

#include <Eigen/Core>

namespace evical {

class BandCholesky;

// On average, by simulation and extrapolation (J. Cook, L. Stefanski, JASA 1994): errors once more of the size that the
// splines already have add once more what these have added. `splines`: their
// information, factored; `total`: that of the quantities where the splines are.
Eigen::MatrixXd informationFromNoise(const UnknownColumns& columns, const BandCholesky& splines,
                                     const Eigen::MatrixXd& total, int threads, const RunContext& context);

}  // namespace evical
