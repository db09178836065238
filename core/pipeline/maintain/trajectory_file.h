// External trajectory: trajectory.csv of a calibration, or TUM's format ("time x y z qx qy qz qw", separated
// by blanks, lines with # ignored).
#pragma once

#include "core/maintenance/trajectory_segment.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical {

// Times below 1e8 are relative to the log's start; from larger ones that start is subtracted. Throws
// CalibrationError (BadInput) for unreadable files, wrong time order, too few poses, and invalid rotations.
std::vector<TimedPose> readTrajectory(const std::filesystem::path& file, std::int64_t log_start_ns);

}  // namespace evical
