// Test of the reference IMU's accelerometer with a trajectory; checks first that the trajectory is of this
// IMU, in metres, and on this clock.
#pragma once

#include "core/maintenance/trajectory_segment.h"
#include "core/pipeline/maintain/maintain_imus.h"

#include <cstddef>
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

}  // namespace evical
