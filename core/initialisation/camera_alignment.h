// Alignment of one camera with the reference IMU's gyroscope: its poses, time offset and rotation
// (docs/maths.md, 8.2 to 8.4).
#pragma once

#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/world_rotation.h"

namespace evical {

// Adds steps and warnings to `result`. Throws CalibrationFailed with advice.
AlignedCamera alignCamera(const CameraData& camera, const CalibrationInput& input, const GyroRotation& gyro,
                          const InitialisationOptions& options, const RunContext& context,
                          Initialisation& result);

}  // namespace evical
