// Initialisation of cameras without an IMU: the reference camera's trajectory, and poses of the others
// relative to it.
#pragma once

#include "core/initialisation/initialise.h"

namespace evical {

// Adds to `result`. Throws CalibrationFailed with advice.
void initialiseCamerasAlone(const CalibrationInput& input, const StatedSigns& stated,
                            const InitialisationOptions& options, const RunContext& context,
                            Initialisation& result);

}  // namespace evical
