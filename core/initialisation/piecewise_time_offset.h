// Time offsets of parts of a recording, compared with one for the whole recording. They reveal clock steps
// (lost packets, a resynchronisation), while a single offset is wrong for a part and contradicted by circles
// that look like outliers.
#pragma once

#include "core/initialisation/camera_imu_rotation.h"

#include <optional>
#include <vector>

namespace evical {

struct OffsetPart {
  double begin_s = 0.0, end_s = 0.0;  // camera clock
  double time_offset_s = 0.0, time_offset_std_s = 0.0;
};
// Offsets of parts of some seconds, with all other parameters from the whole recording.
std::vector<OffsetPart> offsetsByParts(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                       const RelativeRotation& whole, const InitialisationOptions& options);

struct ClockStep {
  double at_s = 0.0;    // camera clock, to within a part
  double step_s = 0.0;  // of the offset, from then on
  double sigmas = 0.0;
  bool larger_part_first = true;
};
// The step that explains the parts best; empty if a constant offset or a drift explains them.
std::optional<ClockStep> findClockStep(const std::vector<OffsetPart>& parts);

}  // namespace evical
