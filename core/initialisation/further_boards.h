// The cameras that see another board than the world's, and where these boards stand.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/camera_trajectory.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/world_rotation.h"

#include <map>

namespace evical {

// `aligned`: by camera; those that see the world's board are left out of account. `body`: the reference's motion in the
// world, known within `gap_s` of its view times. Fills the boards and their cameras in result.state. Throws
// CalibrationFailed where a board is never seen while the world's is.
void alignFurtherBoards(const CalibrationInput& input, const std::map<std::size_t, AlignedCamera>& aligned,
                        const CameraTrajectory& body, double gap_s, const InitialisationOptions& options,
                        Initialisation& result);

}  // namespace evical
