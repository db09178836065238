// What is believed of quantities of which a session says nothing: that they are near what a state has before anything is
// known. The batch weighs it, and so does what combines the results of several.
#pragma once

#include "core/data/quantity.h"
#include "core/geometry/board.h"
#include "core/optimisation/optimisation_options.h"

#include <optional>

namespace evical {

// What a sigma depends on besides the options.
struct PriorOwner {
  int image_height_px = 0;  // of a camera
  const Board* board = nullptr;
  double spacing_sigma = 0.0;  // of that board
};

// Of each of the quantity's numbers; nothing where there is no such prior, or it is one of its own kind.
std::optional<double> weakSigma(const QuantityInfo& info, const OptimisationOptions& options,
                                const PriorOwner& owner);

}  // namespace evical
