// Statistics of a stream of IMU samples that are shared by its check, in SI units, and by its summary, in the
// recording's units. 0 for too few samples.
#pragma once

#include "core/data/imu_units.h"

#include <optional>
#include <vector>

namespace evical {

// Limits beyond which `inspect` and the pipeline report a fault of a recording.
struct InspectionOptions {
  double event_gap_s = 0.1;             // longest time without any event
  double imu_gap_periods = 1.8;         // longest time between IMU samples, in their median interval
  double imu_jitter_periods = 0.2;      // largest RMS of IMU intervals about their median, in medians
  double stuck_axis_s = 1.0;            // an IMU axis that is constant for longer is stuck
  double gravity_tolerance_m_s2 = 0.8;  // of the median norm of the specific force about 9.81 m/s^2
  double largest_rate_rad_s = 36.0;     // larger rates cannot be in rad/s (2000 deg/s are 34.9 rad/s)
  double hot_pixel_factor = 8.0;        // times the events of its neighbours, and of the mean pixel
  double hot_pixel_hz = 10.0;           // lowest rate of a hot pixel
  int hot_pixel_events = 100;           // fewest events that distinguish a hot pixel from chance
  double hot_pixel_share = 0.01;        // of the events, of all hot pixels; less is a note instead of a fault
  bool operator==(const InspectionOptions&) const = default;
};

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
