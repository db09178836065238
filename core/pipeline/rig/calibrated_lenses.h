// Results for lenses that a run has calibrated first, or refined in the batch.
#pragma once

#include "core/geometry/camera_intrinsics.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <string>

namespace evical {

// Advice on a principal point that has moved, which turns the camera by more than `noted_deg`; else empty.
std::string adviceOnMovedLens(const CameraIntrinsics& given, const CameraIntrinsics& solved,
                              double noted_deg);

// Copies the sigmas of lenses that were calibrated alone and not refined by the batch into the result.
void setLensSigmas(const Session& session, CalibrationRun& run);

// Adds notes on calibrated and refined lenses to the result, and its doubt about the first of them.
void addLensNotes(const Session& session, CalibrationRun& run);

}  // namespace evical
