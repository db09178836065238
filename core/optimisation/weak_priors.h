// Default priors: a quantity without a prior in the session is near its value in a new state. The batch and
// the combination of several results use the same sigmas.
#pragma once

#include "core/data/quantity.h"
#include "core/geometry/board.h"
#include "core/optimisation/optimisation_options.h"

#include <optional>

namespace evical {

// Parameters of a sigma in addition to the options.
struct PriorOwner {
  int image_height_px = 0;  // of a camera
  const Board* board = nullptr;
  double spacing_sigma = 0.0;  // of that board
};

// Sigma of each of the quantity's numbers; empty without a weak prior. Lenses and gravity have other priors.
std::optional<double> weakSigma(const QuantityInfo& info, const OptimisationOptions& options,
                                const PriorOwner& owner);

}  // namespace evical
