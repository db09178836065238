// Results for lenses that a run has calibrated first, or refined in the batch.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <string>

namespace evical {

// Advice on a principal point that has moved, which turns the camera by more than `noted_deg`; else empty.
std::string adviceOnMovedLens(const CameraIntrinsics& given, const CameraIntrinsics& solved,
                              double noted_deg);

// Adds notes, sigmas and warnings to the result.
void tellLenses(const Session& session, CalibrationRun& run);

}  // namespace evical
