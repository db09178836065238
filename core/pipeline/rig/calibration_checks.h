// Checks before the estimation: of the session, and of the data that a pass has read and detected.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <span>

namespace evical {

// Throws CalibrationError if there is nothing to calibrate, or if the board is not suitable.
void checkSession(const Session& session);

// Throws CalibrationError if the data show that the session or the recording is unsuitable: units,
// timestamps, dead axes, length, a board that is never seen. Lesser faults are added to those of the pass and
// logged.
void checkPass(const Session& session, const RunContext& context, DetectionResult& detections);

// Adds cause and repair to the error if a sensor's times span a suspicious multiple (2, 1000, or the inverse)
// of another's: a driver doubles times, or ms are read as us. Otherwise returns the error unchanged.
CalibrationError withClockRate(const CalibrationError& error, const Session& session,
                               const BoardObservations& camera, std::span<const ImuData> imus);

}  // namespace evical
