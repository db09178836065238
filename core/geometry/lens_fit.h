// Conversion of a lens to another model.
#pragma once

#include "core/geometry/camera_intrinsics.h"

namespace evical {

struct LensFit {
  CameraIntrinsics camera;
  double rms_px = 0.0, worst_px = 0.0;  // over the image: distance between the two projections of a ray
  bool whole_image = true;              // otherwise rays that the model cannot see were omitted
};

// The camera of `model`, with this number of coefficients (4 for radtan: without k3), that is closest over
// the whole image, by least squares in pixels. Pinholes are fitted up to 85 degrees off axis.
LensFit fitLens(const CameraIntrinsics& camera, CameraModel model, int coefficients);

// Start value for a fit to another lens: without distortion, with the same scale on the axis. The wide models
// are all stereographic then, r = 2 f tan(angle / 2), which is between fisheyes and mirrors.
CameraIntrinsics plainLens(const CameraIntrinsics& like, CameraModel model);

}  // namespace evical
