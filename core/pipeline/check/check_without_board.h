// Check of an old calibration without a board: rotation and time offset of event cameras relative to the
// reference IMU, from the angular rates of both (docs/maths.md, 16).
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/check/boardless_pass.h"
#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/check/check_session.h"

namespace evical {

// Reads the recording. An uninformative recording gives a verdict, not an error. Throws as checkCalibration.
CheckRun checkWithoutBoard(const CheckInput& input, const RunContext& context);

// The same from data that were read before.
CheckRun checkWithoutBoard(const CheckInput& input, BoardlessPass pass, const RunContext& context = {});

}  // namespace evical
