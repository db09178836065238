// Numbers about a stream of IMU samples that its check, in SI units, and its summary, in the recording's,
// share. 0 for too few samples.
#pragma once

#include "core/data/imu_units.h"

#include <vector>

namespace evical {

double medianInterval_s(const std::vector<ImuSample>& samples);
double medianInterval_s(const std::vector<RawImuSample>& samples);
// Of finite samples only; in the unit of the samples.
double medianForceNorm(const std::vector<ImuSample>& samples);
double medianForceNorm(const std::vector<RawImuSample>& samples);
double largestRate(const std::vector<ImuSample>& samples);
double largestRate(const std::vector<RawImuSample>& samples);

}  // namespace evical
