// One lens in the numbers of another model.
#pragma once

#include "core/geometry/camera_intrinsics.h"

namespace evical {

struct LensFit {
  CameraIntrinsics camera;
  double rms_px = 0.0, worst_px = 0.0;  // over the image: how far apart both see the same ray
  bool whole_image = true;              // otherwise rays that the model cannot see were omitted
};

// The camera of `model`, with so many of its coefficients (4 of radtan: without k3), that comes nearest over the whole
// image, by least squares of pixels. Pinholes are fitted up to 85 degrees off axis.
LensFit fitLens(const CameraIntrinsics& camera, CameraModel model, int coefficients);

// Start of a fit to another lens: without distortion, with the same scale on the axis. The wide models are
// all three stereographic then, r = 2 f tan(angle / 2), which is between fisheyes and mirrors.
CameraIntrinsics plainLens(const CameraIntrinsics& like, CameraModel model);

}  // namespace evical
