// Initialisation of cameras without an IMU: the reference camera's trajectory, and poses of the others
// relative to it.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/initialise.h"

#include <optional>
#include <vector>

namespace evical {

// Adds to `result`. Throws CalibrationFailed with advice.
void initialiseCamerasAlone(const CalibrationInput& input, const StatedSigns& stated,
                            const InitialisationOptions& options, const RunContext& context,
                            Initialisation& result);

// Relative pose of two cameras that see the board alternately, without an IMU for the motion in between: when
// one loses the board and the other detects it, both are extrapolated to the middle of the gap at constant
// speed (docs/maths.md, 10.5).
struct BridgedCamera {
  MeanPose reference_from_camera;
  double time_offset_s = 0.0;  // reference_time = camera_time + time_offset_s
  int bridges = 0;             // number of gaps used
};

// Result for the time offset within options.time_offset_search_s of the prior's at which the gaps agree best,
// or for the given one. Empty if there are too few gaps of at most options.max_bridge_s, or if they do
// not agree.
std::optional<BridgedCamera> bridgeCameras(const std::vector<CameraPose>& reference,
                                           const std::vector<CameraPose>& camera,
                                           const std::optional<KnownNumber>& time_offset,
                                           const InitialisationOptions& options, const RunContext& context);

}  // namespace evical
