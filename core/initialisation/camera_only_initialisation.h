// Cameras without an IMU: the reference camera's trajectory, and how the others sit on it.
#pragma once

#include "core/initialisation/initialise.h"

namespace evical {

// Into `result`. Throws CalibrationFailed, with what to do.
void initialiseCamerasAlone(const CalibrationInput& input, const InitialisationOptions& options,
                            const RunContext& context, Initialisation& result);

}  // namespace evical
