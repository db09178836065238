// Residuals of priors, and fixed blocks.
#pragma once

#include "core/optimisation/problem_builder.h"

namespace evical {

// Weak priors of the options, for quantities without a prior in the session; along fixed axes also with one.
// Only blocks that have measurements in the problem get any.
void addPriors(ProblemBuilder& builder);

// Priors and given values of the session.
void addKnownValues(ProblemBuilder& builder);

// Smoothness of the trajectory if no IMU bridges gaps between views.
void addSmoothness(ProblemBuilder& builder);

}  // namespace evical
