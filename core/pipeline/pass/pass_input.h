// Input of initialisation and batch from a pass.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/mirror_check.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

namespace evical {

// Combines the data with the session's sensors. Moves the data of cameras and IMUs out of the pass: in long
// recordings they are most of the memory.
CalibrationInput makeInput(const Session& session, DetectionResult& pass);

// Statements of the session about mirrored images and signs of accelerations.
StatedSigns statedSigns(const Session& session);

// Moves the data back; an empty input has no effect.
void restorePass(CalibrationInput input, DetectionResult& pass);

}  // namespace evical
