// A trajectory from elsewhere: trajectory.csv as a calibration writes it, or TUM's format ("time x y z qx qy qz qw", with
// blanks, lines with # left out).
#pragma once

#include "core/maintenance/trajectory_segment.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical {

// Times are since the log's start where the file has them so (smaller than 1e8), else less that start. Throws
// CalibrationError (BadInput): unreadable, not in order of time, no poses, rotations that are none.
std::vector<TimedPose> readTrajectory(const std::filesystem::path& file, std::int64_t log_start_ns);

}  // namespace evical
