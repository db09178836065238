// Random laboratories: rigs, boards, lenses, light, pixels and motions that are drawn for each number, in
// families that have something in common.
#pragma once

#include "core/synthetic/scenario.h"

#include <array>
#include <string_view>

namespace evical::benchmarks {

// Usual: everything as drawn. Memory: pixels with a refractory period of 1 ms. Clutter: discs around the
// board. Squares: checkerboards, AprilGrids and ChArUco boards in any print.
enum class LaboratoryFamily { Usual, Calm, Brisk, Dim, Memory, Clutter, Squares };
inline constexpr std::array<std::string_view, 7> kLaboratoryFamilies = {"usual",  "calm",    "brisk",  "dim",
                                                                        "memory", "clutter", "squares"};

// `exact`: a session without the usual errors of board size and lens.
Scenario drawLaboratory(LaboratoryFamily family, int number, bool exact);

}  // namespace evical::benchmarks
