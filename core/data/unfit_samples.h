// IMU samples from which nothing can be estimated: where a sensor was at its limit, and isolated errors (a
// flipped bit, a tap on the table) that their neighbours contradict.
#pragma once

#include "core/data/imu_sample.h"
#include "core/data/recording_fault.h"

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

// Whether a sample's numbers can come from any sensor, in whatever unit they were mistaken: no motion is of
// 10 000 rad/s (the fastest gyroscopes end at 70, 4000 in deg/s) or 10 000 g (16 g are 16 000 mg).
bool isMeasurable(const ImuSample& sample);

// Indices of samples, ascending.
struct UnfitSamples {
  std::array<std::vector<std::size_t>, kImuAxes.size()> saturated;
  std::vector<std::size_t> gyroscope_spikes, accelerometer_spikes;
  // Repeats of the sample before, where a sensor is slower than its stream and each of its samples is held.
  std::vector<std::size_t> gyroscope_repeats, accelerometer_repeats;
  std::vector<std::size_t> without_rate, without_force;  // only the other sensor measured these
};

// Of samples that are measurable.
UnfitSamples findUnfitSamples(std::span<const ImuSample> samples);

// What is said of sensors whose samples are held.
std::vector<RecordingFault> heldFaults(const std::string& stream, std::span<const ImuSample> samples,
                                       const UnfitSamples& unfit);

// Which samples of the two sensors take part, in their order: 1 if one does.
struct SampleSelection {
  std::vector<std::uint8_t> gyroscope, accelerometer;

  bool operator==(const SampleSelection&) const = default;
};

// All but the unfit ones and those beside a saturated one: a filter before the limit, or a mean over a
// sampling period, takes part of it there.
SampleSelection fitSamples(std::span<const ImuSample> samples);

// For who integrates rates: of a saturated sample two axes are right, and the third is nearer to the truth
// than nothing.
std::vector<ImuSample> withoutRateSpikes(std::span<const ImuSample> samples);
// Takes only valid samples that the accelerometer measured.
std::vector<ImuSample> withFitForces(std::span<const ImuSample> samples);

}  // namespace evical
