// Results for lenses that a run has calibrated first, or refined in the batch.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

namespace evical {

// Adds notes, sigmas and warnings to the result.
void tellLenses(const Session& session, CalibrationRun& run);

}  // namespace evical
