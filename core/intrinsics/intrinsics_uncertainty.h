// How sure the intrinsics are (docs/maths.md, 7.4): Schur complement over the views' poses, scaled by the
// residuals' variance; where errors that the circles of a view, or of neighbouring views, have in common ask
// for more, they prevail (as in core/optimisation/uncertainty/covariance.h).
#pragma once

#include "core/data/intrinsics_result.h"
#include "core/intrinsics/bundle.h"

namespace evical {

struct BundleUncertainty {
  IntrinsicsMatrix covariance = IntrinsicsMatrix::Zero();  // zero where a parameter is fixed
  double edge_lead_std_px = 0.0;
  double normalised_rms = 0.0;  // of residuals over their sigmas
};

BundleUncertainty bundleUncertainty(const Bundle& bundle, const Board& board,
                                    const IntrinsicsOptions& options);

// Coverage by the circles used, and what the covariance means for the pixels of given rays. A turn of the
// camera is taken out of each parameter's effect: poses take it up, and it does no harm.
ImageMap imageMap(const Bundle& bundle, const IntrinsicsMatrix& covariance);

// The map's sigmas anew; what it covers stays.
void setSigmas(const CameraIntrinsics& intrinsics, const IntrinsicsMatrix& covariance, ImageMap& map);

}  // namespace evical
