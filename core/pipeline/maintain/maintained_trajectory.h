// What a trajectory says of the reference IMU's accelerometer; first whether it is this IMU's, in metres, on this clock.
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
  double later_s = 0.0;  // what was added to its times
};

// Throws CalibrationError (BadInput) where the trajectory is of another body, frame, scale or time.
TrajectoryRun runTrajectory(const MaintainInput& input, std::size_t imu, double gravity_m_s2,
                            const RunContext& context);

}  // namespace evical
