// Whether an old calibration still holds where there is no board: rotation and time offset of event cameras against the
// reference IMU, from how both turn (docs/maths.md, 16).
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/check/boardless_pass.h"
#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/check/check_session.h"

namespace evical {

// Reads the recording. A recording that tells nothing is a verdict, no error. Throws as checkCalibration.
CheckRun checkWithoutBoard(const CheckInput& input, const RunContext& context);

// The same from what was read.
CheckRun checkWithoutBoard(const CheckInput& input, BoardlessPass pass, const RunContext& context = {});

}  // namespace evical
