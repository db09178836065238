// Statistics of a stream of IMU samples that are shared by its check, in SI units, and by its summary, in the
// recording's units. 0 for too few samples.
#pragma once

#include "core/data/imu_units.h"
#include "core/recording/inspection_options.h"

#include <optional>
#include <vector>

namespace evical {

double medianInterval_s(const std::vector<ImuSample>& samples);
double medianInterval_s(const std::vector<RawImuSample>& samples);
// Median norm of the finite samples; in the samples' unit.
double medianForceNorm(const std::vector<ImuSample>& samples);
double medianForceNorm(const std::vector<RawImuSample>& samples);
// Median over pieces of 2 s of the norm of the mean specific force, rotated by the gyroscope into one frame
// per piece: gravity, also with fast motion, since hands come back. nullopt without a complete piece.
std::optional<double> steadyForceNorm(const std::vector<ImuSample>& samples);
bool isGravity(double norm_m_s2, const InspectionOptions& options);
double largestRate(const std::vector<ImuSample>& samples);
double largestRate(const std::vector<RawImuSample>& samples);

}  // namespace evical
