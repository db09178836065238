// The result's tables for other programs: comma-separated, with a line of names.
#pragma once

#include "core/data/calibration_state.h"

#include <string>

namespace evical {

// time_s (reference IMU's clock, since the recording's start, which is recording.start_ns of result.yaml),
// position and quaternion of world_from_imu at 200 Hz.
std::string trajectoryCsv(const CalibrationState& state);

}  // namespace evical
