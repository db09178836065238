// Cameras in the models that other programs know.
#pragma once

#include "core/report/export/rig.h"

#include "core/geometry/camera_intrinsics.h"

#include <string>

namespace evical {

struct FittedCamera {
  CameraIntrinsics camera;
  double rms_px = 0.0, worst_px = 0.0;  // over the image: how far apart both see the same ray
};

// The camera of another model, or with fewer coefficients (4 of radtan: without k3), that comes nearest over
// the whole image, by least squares of pixels.
FittedCamera fitDistortion(const CameraIntrinsics& camera, CameraModel model, int coefficients);

// What a program can hold.
struct KnownModels {
  const char* program;
  bool radtan = true, third_radial = false, equidistant = true;
};

// The camera as it is where the program can hold it; else refitted, with a note of the error; where that is
// more than 2 px anywhere in the image, throws CalibrationError (BadInput).
CameraIntrinsics cameraFor(const RigCamera& camera, const KnownModels& known, ExportNotes& notes);

// In the program's words, 4 or 5 numbers: OpenCV's order, k3 (`coefficients` = 5) last.
std::vector<double> distortionOf(const CameraIntrinsics& camera, int coefficients);

}  // namespace evical
