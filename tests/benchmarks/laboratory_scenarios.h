// Random laboratories: rigs, boards, lenses, light, pixels and motions that are drawn for each number.
#pragma once

#include "core/synthetic/scenario.h"

namespace evical::benchmarks {

// `exact`: a session without the usual errors of board size and lens.
Scenario drawLaboratory(int number, bool exact);

}  // namespace evical::benchmarks
