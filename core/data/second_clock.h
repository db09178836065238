// Stretches of an IMU's samples that another clock has stamped: some drivers double the time for a while. Where a stretch begins
// the time jumps ahead, at its end it jumps back, and the samples around it go on as if nothing had been.
#pragma once

#include "core/data/imu_sample.h"
#include "core/data/recording_fault.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct SecondClock {
  std::size_t begin = 0, end = 0;  // samples, in the order in which they were recorded
  double rate = 1.0;               // how many times as fast as the right clock it ran
};

// In the order in which they were recorded, ascending; none where the samples around a stretch do not fit together.
std::vector<SecondClock> findSecondClocks(std::span<const ImuSample> samples);

RecordingFault faultOf(const std::string& stream, std::span<const ImuSample> samples,
                       const SecondClock& clock);

}  // namespace evical
