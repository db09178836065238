// Biases that drift, as comma separated text: one line a knot of each IMU, between
// which they are straight lines.
#pragma once

#include "core/report/result_yaml.h"

#include <string>

namespace evical {

// imu, time_s (the IMU's own clock, since the recording's start), biases and their standard deviations. Empty
// where all biases are constant.
std::string biasesCsv(const NamedResult& named);

}  // namespace evical
