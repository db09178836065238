// What stands against a calibration before anything is estimated: in the session, and in what a pass has read and
// detected.
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/recording_pass.h"
#include "core/pipeline/session.h"

namespace evical {

// Throws CalibrationError where there is nothing to be calibrated, or not with this board.
void checkSession(const Session& session);

// Throws CalibrationError where the recording itself shows that the session or the recording is unfit: units, stamps,
// dead axes, its length, a board that is not seen. Lesser faults are added to the pass's, and told with what was found.
void checkPass(const Session& session, const RunContext& context, RecordingPass& pass);

}  // namespace evical
