// Uncertainty of the intrinsics (docs/maths.md, 7.4): Schur complement over the views' poses, scaled by the
// residuals' variance, and increased to allow for errors that the circles of a view, or of neighbouring
// views, have in common (as in core/optimisation/uncertainty/covariance.h).
#pragma once

#include "core/data/intrinsics_result.h"
#include "core/intrinsics/bundle.h"

namespace evical {

struct BundleUncertainty {
  IntrinsicsMatrix covariance = IntrinsicsMatrix::Zero();  // zero where a parameter is fixed
  double edge_localisation_bias_std_px = 0.0;
  double normalised_rms = 0.0;  // of residuals over their sigmas
};

BundleUncertainty bundleUncertainty(const Bundle& bundle, const Board& board,
                                    const IntrinsicsOptions& options);

// Coverage by the used circles, and the covariance's effect on the pixels of given rays. A rotation of the
// camera is removed from each parameter's effect: poses absorb it.
ImageMap imageMap(const Bundle& bundle, const IntrinsicsMatrix& covariance);

// Updates the map's sigmas; its coverage is unchanged.
void setSigmas(const CameraIntrinsics& intrinsics, const IntrinsicsMatrix& covariance, ImageMap& map);

}  // namespace evical
