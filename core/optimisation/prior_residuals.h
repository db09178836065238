// What weighs on the unknowns besides measurements, and what is held.
#pragma once

#include "core/optimisation/problem_builder.h"

namespace evical {

// Of the options, where the session says nothing itself; along held axes also where it does. Only blocks that
// measurements brought into the problem get any.
void addPriors(ProblemBuilder& builder);

// Of the session: what it weighs and what it gives.
void addKnownValues(ProblemBuilder& builder);

// On the trajectory where no IMU fills the gaps between views.
void addSmoothness(ProblemBuilder& builder);

}  // namespace evical
