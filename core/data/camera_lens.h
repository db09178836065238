// One camera's lens in a calibration, from the prior to the result.
#pragma once

#include "core/data/intrinsics_result.h"

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

// Uncertainty of a given lens, from its file. Numbers in the order of intrinsics_result.h.
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

struct CameraLens {
  std::optional<CameraIntrinsics> given = {};  // from the session; absent: unknown
  std::optional<CameraIntrinsics> detection_intrinsics =
      {};                                          // of the front end: observations are in its ideal pixels
  std::optional<CameraIntrinsics> solved = {};     // from the joint estimate, if it was free
  std::optional<LensUncertainty> given_with = {};  // of the given lens; absent: not specified

  // Calibrated before the joint estimate, from the same recording.
  bool foundFirst() const { return detection_intrinsics && !given; }
  // The best estimate: use it to project points into the camera's image.
  const std::optional<CameraIntrinsics>& inUse() const { return solved ? solved : detection_intrinsics; }
  // The result of the calibration; empty if the lens was fixed at the given one.
  std::optional<CameraIntrinsics> found() const { return solved || !given ? inUse() : std::nullopt; }

  bool operator==(const CameraLens&) const = default;
};

// A lens that is known beforehand, or unknown.
inline CameraLens givenLens(const std::optional<CameraIntrinsics>& intrinsics,
                            const std::optional<LensUncertainty>& uncertainty = {}) {
  return {intrinsics, intrinsics, {}, intrinsics ? uncertainty : std::nullopt};
}

}  // namespace evical
