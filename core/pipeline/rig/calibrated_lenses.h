// What a run says of lenses that it has calibrated itself, or solved for again with everything else.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

namespace evical {

// Notes, sigmas and doubts of the result.
void tellLenses(const Session& session, CalibrationRun& run);

}  // namespace evical
