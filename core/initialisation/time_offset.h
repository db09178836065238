// Coarse time offset from magnitudes of rotation (docs/maths.md, 8.3): the camera's angle between
// neighbouring views does not depend on its mounting, and must equal the gyroscope's.
#pragma once

#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/initialisation_options.h"

#include "core/data/calibration_setup.h"

#include <optional>
#include <vector>

namespace evical {

struct TimeOffsetPeak {
  double time_offset_s = 0.0;
  double correlation = 0.0;   // of rotation rates, -1..1
  double significance = 0.0;  // of the correlation, given the overlap: short ones agree by chance more easily
  double width_s = 0.0;       // distance from the peak at which the correlation's parabola is lower by 0.1
};

// Mean angular rate between two views of a camera.
struct RatePair {
  double middle_s, rate_rad_s, duration_s;
};
// Pairs of nearly equal duration from `gap_s` to `longest_s`, so that both sensors' rates are averaged alike.
std::vector<RatePair> ratePairs(const std::vector<CameraPose>& poses, double gap_s, double longest_s);

// Local maxima of the correlation within plus or minus options.time_offset_search_s of the prior's time
// offset (of 0 without one), the most significant first; only the given offset if there is one. Empty if
// camera and gyroscope overlap for less than options.min_overlap_s at every offset.
std::vector<TimeOffsetPeak> correlateTimeOffset(const std::vector<CameraPose>& poses,
                                                const GyroRotation& gyro,
                                                const InitialisationOptions& options,
                                                const SensorPrior& prior = {});

// Time offsets of parts of a recording, compared with one for the whole recording. They reveal clock steps
// (lost packets, a resynchronisation), while a single offset is wrong for a part and contradicted by circles
// that look like outliers.
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
