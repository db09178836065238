// Cameras in the models that other programs know.
#pragma once

#include "core/export/rig.h"

#include "core/geometry/camera_intrinsics.h"

#include <string>

namespace evical {

// What a program can hold; one of radtan and equidistant at least.
struct KnownModels {
  const char* program;
  bool radtan = true, third_radial = false, equidistant = true;
  bool double_sphere = false, eucm = false, omni = false;
};

// The camera as it is where the program can hold it; else refitted (lens_fit.h), with a note of the error; where that is
// more than 2 px anywhere in the image, throws CalibrationError (BadInput).
CameraIntrinsics cameraFor(const RigCamera& camera, const KnownModels& known, ExportNotes& notes);

// In the program's words, 4 or 5 numbers: OpenCV's order, k3 (`coefficients` = 5) last.
std::vector<double> distortionOf(const CameraIntrinsics& camera, int coefficients);

}  // namespace evical
