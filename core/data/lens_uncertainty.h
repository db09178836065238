// Uncertainty of a given lens, from its file. Numbers in the order of intrinsics_result.h.
#pragma once

#include "core/data/intrinsics_result.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

struct LensUncertainty {
  IntrinsicsVector std = IntrinsicsVector::Zero();  // 0: not specified; the default applies
  std::optional<IntrinsicsMatrix> correlation = {};

  bool operator==(const LensUncertainty&) const = default;

  // Without correlations, sigmas are doubled: errors of the focal lengths are correlated, and those of the
  // coefficients too, so that independent errors of that size would underestimate the uncertainty.
  IntrinsicsMatrix covariance() const {
    constexpr double kWithoutCorrelation = 2.0;
    if (correlation) return std.asDiagonal() * *correlation * std.asDiagonal();
    return (kWithoutCorrelation * std).cwiseAbs2().asDiagonal();
  }
};

}  // namespace evical
