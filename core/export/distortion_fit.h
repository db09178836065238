// Cameras in the lens models of other programs.
#pragma once

#include "core/export/rig.h"

#include "core/geometry/camera_intrinsics.h"

#include <string>

namespace evical {

// Lens models of a program; at least one of radtan and equidistant.
struct KnownModels {
  const char* program;
  bool radtan = true, third_radial = false, equidistant = true;
  bool double_sphere = false, eucm = false, omni = false;
};

// The camera unchanged if the program supports it; otherwise refitted (lens_fit.h), with a note of the error.
// Throws CalibrationError (BadInput) if the error exceeds 2 px anywhere in the image.
CameraIntrinsics cameraFor(const RigCamera& camera, const KnownModels& known, ExportNotes& notes);

// In the order of the program, 4 or 5 numbers: OpenCV's order, k3 (`coefficients` = 5) last.
std::vector<double> distortionOf(const CameraIntrinsics& camera, int coefficients);

}  // namespace evical
