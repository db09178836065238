// Residuals of priors, and fixed blocks.
#pragma once

#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/problem_builder.h"

#include "core/data/quantity.h"
#include "core/geometry/board.h"

#include <optional>

namespace evical {

// Weak priors of the options, for quantities without a prior in the session; along fixed axes also with one.
// Only blocks that have measurements in the problem get any.
void addPriors(ProblemBuilder& builder);

// Priors and given values of the session.
void addKnownValues(ProblemBuilder& builder);

// Smoothness of the trajectory if no IMU bridges gaps between views.
void addSmoothness(ProblemBuilder& builder);

// Default priors: a quantity without a prior in the session is near its value in a new state. The batch and
// the combination of several results use the same sigmas.

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
