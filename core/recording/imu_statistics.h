// Numbers about a stream of IMU samples that its check and its summary share. 0 for too few samples.
#pragma once

#include "core/data/imu_sample.h"

#include <vector>

namespace evical {

double medianInterval_s(const std::vector<ImuSample>& samples);
double medianForceNorm(const std::vector<ImuSample>& samples);  // finite samples only; unit of the samples
double largestRate(const std::vector<ImuSample>& samples);

}  // namespace evical
