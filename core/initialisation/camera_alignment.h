// One camera against the reference IMU's gyroscope: its poses, time offset and rotation
// (docs/maths.md, 8.2 to 8.4).
#pragma once

#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/world_rotation.h"

namespace evical {

// Steps and warnings go into `result`. Throws CalibrationFailed, with what to do.
AlignedCamera alignCamera(const CameraData& camera, const CalibrationInput& input, const GyroRotation& gyro,
                          const InitialisationOptions& options, const RunContext& context,
                          Initialisation& result);

}  // namespace evical
