// What stands against a calibration before anything is estimated: in the session, and in what a pass has read and
// detected.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <span>

namespace evical {

// Throws CalibrationError where there is nothing to be calibrated, or not with this board.
void checkSession(const Session& session);

// Throws CalibrationError where the recording itself shows that the session or the recording is unfit: units, stamps,
// dead axes, its length, a board that is not seen. Lesser faults are added to the pass's, and told with what was found.
void checkPass(const Session& session, const RunContext& context, DetectionResult& pass);

// Where a sensor's times span a suspicious multiple of another's (2, 1000, or a part), because a driver doubles time or ms are
// read as us: the error with this cause and the repair. Else the error as it is.
CalibrationError withClockRate(const CalibrationError& error, const Session& session,
                               const BoardObservations& camera, std::span<const ImuData> imus);

}  // namespace evical
