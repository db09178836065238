// What initialisation and the batch are given of a pass.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

namespace evical {

// With what the session says of its sensors. Takes what cameras and IMUs saw out of the pass: of long recordings that
// is most of the memory.
CalibrationInput makeInput(const Session& session, DetectionResult& pass);

// Gives it back; an input that took nothing changes nothing.
void restorePass(CalibrationInput input, DetectionResult& pass);

}  // namespace evical
