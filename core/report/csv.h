// The result's tables as text for other programs: comma separated, one line of names.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/calibration_state.h"

#include <string>
#include <vector>

namespace evical {

// time_s (reference IMU's clock, since the recording's start, which is recording.start_ns of result.yaml),
// position and quaternion of world_from_imu at 200 Hz.
std::string trajectoryCsv(const CalibrationState& state);

// One line a circle: where it was, how sure, how fast.
std::string detectionsCsv(const std::vector<BoardObservations>& cameras);

// One line a window: what became of it.
std::string windowsCsv(const std::vector<BoardObservations>& cameras);

}  // namespace evical
