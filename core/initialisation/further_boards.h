// Poses of further boards, and of the cameras that see them.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/camera_trajectory.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/world_rotation.h"

#include <map>

namespace evical {

// `aligned`: by camera; those that see the world's board are ignored. `body`: the reference's motion in the
// world, known within `gap_s` of its view times. Sets the boards and their cameras in result.state. Throws
// CalibrationFailed if a board is never seen at the same time as the world's.
void alignFurtherBoards(const CalibrationInput& input, const std::map<std::size_t, AlignedCamera>& aligned,
                        const CameraTrajectory& body, double gap_s, const InitialisationOptions& options,
                        Initialisation& result);

}  // namespace evical
