// Numbers about a stream of IMU samples that its check, in SI units, and its summary, in the recording's,
// share. 0 for too few samples.
#pragma once

#include "core/data/imu_units.h"
#include "core/recording/inspection_options.h"

#include <optional>
#include <vector>

namespace evical {

double medianInterval_s(const std::vector<ImuSample>& samples);
double medianInterval_s(const std::vector<RawImuSample>& samples);
// Median norm of finite samples only; in the unit of the samples.
double medianForceNorm(const std::vector<ImuSample>& samples);
double medianForceNorm(const std::vector<RawImuSample>& samples);
// Median over pieces of 2 s of the norm of the mean specific force, turned by the gyroscope into one frame
// each: gravity, however brisk the motion, since hands come back. None where no piece is whole.
std::optional<double> steadyForceNorm(const std::vector<ImuSample>& samples);
bool isGravity(double norm_m_s2, const InspectionOptions& options);
double largestRate(const std::vector<ImuSample>& samples);
double largestRate(const std::vector<RawImuSample>& samples);

}  // namespace evical
