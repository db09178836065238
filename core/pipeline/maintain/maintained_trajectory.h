// Test of the reference IMU's accelerometer with a trajectory; checks first that the trajectory is of this
// IMU, in metres, and on this clock.
#pragma once

#include "core/maintenance/trajectory_segment.h"
#include "core/pipeline/maintain/maintain_imus.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace evical {

struct TrajectoryRun {
  std::vector<LagEstimate> lags;
  LagSum sum;
  double later_s = 0.0;  // offset that was added to its times
};

// Throws CalibrationError (BadInput) if the trajectory has another body, frame, scale or time.
TrajectoryRun runTrajectory(const MaintainInput& input, std::size_t imu, double gravity_m_s2,
                            const RunContext& context);

// External trajectory: trajectory.csv of a calibration, or TUM's format ("time x y z qx qy qz qw", separated
// by blanks, lines with # ignored).

// Times below 1e8 are relative to the log's start; from larger ones that start is subtracted. Throws
// CalibrationError (BadInput) for unreadable files, wrong time order, too few poses, and invalid rotations.
std::vector<TimedPose> readTrajectory(const std::filesystem::path& file, std::int64_t log_start_ns);

}  // namespace evical
