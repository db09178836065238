// Stretches of an IMU's samples with stamps of another clock: some drivers double the time for a while. Time
// jumps ahead at the beginning of a stretch, and back at its end; the samples before and after it are
// consistent.
#pragma once

#include "core/data/imu_sample.h"
#include "core/data/recording.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct SecondClock {
  std::size_t begin = 0, end = 0;  // samples, in the order in which they were recorded
  double rate = 1.0;               // rate relative to the right clock
};

// In the order of recording, ascending; none if the samples before and after a stretch are not consistent.
std::vector<SecondClock> findSecondClocks(std::span<const ImuSample> samples);

// `first_ns`: first time of the stream.
RecordingFault faultOf(const std::string& stream, std::int64_t first_ns, std::span<const ImuSample> samples,
                       const SecondClock& clock);

}  // namespace evical
