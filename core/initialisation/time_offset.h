// Coarse time offset from the sizes of rotation (method 5.3): how far the camera turned between neighbouring
// views does not depend on how it is mounted, and the gyroscope must have turned as far.
#pragma once

#include "core/initialisation/camera_poses.h"

#include <vector>

namespace evical {

struct TimeOffsetPeak {
  double time_offset_s = 0.0;
  double correlation = 0.0;  // of rotation rates, -1..1
};

// Local maxima of the correlation within plus or minus `search_s`, best first; empty if there is too little
// overlap.
std::vector<TimeOffsetPeak> correlateTimeOffset(const std::vector<CameraPose>& poses,
                                                const GyroRotation& gyro, double search_s,
                                                double longest_pair_s);

}  // namespace evical
