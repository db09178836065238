// Results for lenses that a run has calibrated first, or refined in the batch.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <string>

namespace evical {

// What a large shift of the principal point means for the camera's rotation; empty if it is small.
std::string adviceOnMovedLens(const CameraIntrinsics& given, const CameraIntrinsics& solved);

// Adds notes, sigmas and warnings to the result.
void tellLenses(const Session& session, CalibrationRun& run);

}  // namespace evical
