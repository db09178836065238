// The result's tables for other programs: comma-separated, with a line of names.
#pragma once

#include "core/base/atomic_file.h"
#include "core/data/calibration_state.h"
#include "core/report/result_yaml.h"

#include <span>
#include <string>

namespace evical {

// time_s (reference IMU's clock, since the recording's start, which is recording.start_ns of result.yaml),
// position and quaternion of world_from_imu at 200 Hz.
std::string trajectoryCsv(const CalibrationState& state);

// The residuals of a result's circles as a table, with all digits.

// One line for each circle: measured position as in the detections, residual of the prediction after all
// corrections, sigmas, and whether the estimate uses it. `view` counts the camera's windows with the board in
// the detections.
void residualsCsv(const NamedResult& named, std::span<const CircleResidual> residuals, const TextSink& sink);

// Drifting biases as comma-separated text: one line for each knot of each IMU. Biases are linear between
// knots.

// Columns: imu, time_s (the IMU's own clock, since the recording's start), biases and their standard
// deviations. Empty if all biases are constant.
std::string biasesCsv(const NamedResult& named);

}  // namespace evical
