// Drifting biases as comma-separated text: one line for each knot of each IMU. Biases are linear between
// knots.
#pragma once

#include "core/report/result_yaml.h"

#include <string>

namespace evical {

// Columns: imu, time_s (the IMU's own clock, since the recording's start), biases and their standard
// deviations. Empty if all biases are constant.
std::string biasesCsv(const NamedResult& named);

}  // namespace evical
