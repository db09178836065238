// How well a lens is known beforehand, as the file says that gives it. Numbers in the order of intrinsics_result.h.
#pragma once

#include "core/data/intrinsics_result.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

struct LensUncertainty {
  IntrinsicsVector std = IntrinsicsVector::Zero();  // 0: not known any better than usual
  std::optional<IntrinsicsMatrix> correlation = {};

  bool operator==(const LensUncertainty&) const = default;

  // Without correlations sigmas count doubled: both focal lengths err together, and coefficients among each other, so
  // that independent ones of that size would claim more than is known.
  IntrinsicsMatrix covariance() const {
    constexpr double kWithoutCorrelation = 2.0;
    if (correlation) return std.asDiagonal() * *correlation * std.asDiagonal();
    return (kWithoutCorrelation * std).cwiseAbs2().asDiagonal();
  }
};

}  // namespace evical
