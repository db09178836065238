// Default priors: a quantity without a prior in the session is near its value in a new state, and a lens near
// the one that the board was detected with. The batch and the combination of several results use the same
// sigmas.
#pragma once

#include "core/data/camera_lens.h"
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

// All nine intrinsics around the detection intrinsics, with the sigmas given for the lens, otherwise weak.
IntrinsicsMatrix lensPriorCovariance(const CameraLens& lens, const OptimisationOptions& options);

}  // namespace evical
