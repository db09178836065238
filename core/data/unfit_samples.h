// IMU samples that are unusable for estimation: saturated ones, and isolated errors (a flipped bit, a tap on
// the table) that contradict their neighbours.
#pragma once

#include "core/data/imu_sample.h"
#include "core/data/recording.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct ImuAxis {
  const char* name;
  bool rate;  // else specific force
  int index;

  double of(const ImuSample& sample) const {
    return (rate ? sample.angular_rate_rad_s : sample.specific_force_m_s2)[index];
  }
};
inline constexpr std::array<ImuAxis, 6> kImuAxes = {{{"angular rate x", true, 0},
                                                     {"angular rate y", true, 1},
                                                     {"angular rate z", true, 2},
                                                     {"specific force x", false, 0},
                                                     {"specific force y", false, 1},
                                                     {"specific force z", false, 2}}};

// True if a sample's numbers are possible for any sensor, even in a wrong unit: no motion reaches 10 000
// rad/s (the fastest gyroscopes reach 70, 4000 in deg/s) or 10 000 g (16 g are 16 000 mg).
bool isMeasurable(const ImuSample& sample);

// Indices of samples, ascending.
struct UnfitSamples {
  std::array<std::vector<std::size_t>, kImuAxes.size()> saturated;
  std::vector<std::size_t> gyroscope_spikes, accelerometer_spikes;
  // Repeats of the sample before, if a sensor is slower than its stream.
  std::vector<std::size_t> gyroscope_repeats, accelerometer_repeats;
  std::vector<std::size_t> without_rate, without_force;  // only the other sensor measured these
};

// Expects only measurable samples.
UnfitSamples findUnfitSamples(std::span<const ImuSample> samples);

// Shares of each axis' samples at its limit.
std::array<double, kImuAxes.size()> saturatedShares(std::span<const ImuSample> samples);

// Reports of sensors whose samples are repeated.
std::vector<RecordingFault> heldFaults(const std::string& stream, std::span<const ImuSample> samples,
                                       const UnfitSamples& unfit);

// Samples of the two sensors that are used, in their order: 1 if used.
struct SampleSelection {
  std::vector<std::uint8_t> gyroscope, accelerometer;

  bool operator==(const SampleSelection&) const = default;
};

// All except the unfit ones and those next to a saturated one: a filter before the limit, or a mean over a
// sampling period, is affected there.
SampleSelection fitSamples(std::span<const ImuSample> samples);

// For the integration of rates: two axes of a saturated sample are correct, and the third is a better
// estimate than none.
std::vector<ImuSample> withoutRateSpikes(std::span<const ImuSample> samples);
// Only valid samples that the accelerometer measured.
std::vector<ImuSample> withFitForces(std::span<const ImuSample> samples);

}  // namespace evical
