// Measurements of a drive's IMUs, and its trajectory.
#pragma once

#include "core/data/imu_sample.h"
#include "core/synthetic/drive_scenario.h"
#include "core/synthetic/sinusoid_motion.h"

#include <Eigen/Geometry>

#include <array>
#include <string>
#include <vector>

namespace evical {

// Stamps on the IMU's own clock, nanoseconds in the scenario's epoch; SI units.
std::vector<ImuSample> simulateDriveImu(const DriveScenario& scenario, std::size_t imu);

// trajectory.csv as a calibration writes it, with noise; empty unless the scenario asks for one.
std::string driveTrajectoryCsv(const DriveScenario& scenario);

// The motion of a drive (DriveMotion), analytic to its second derivative.
class DriveMotionModel {
 public:
  explicit DriveMotionModel(const DriveScenario& scenario);

  // State of the reference IMU, at seconds since the start on its clock. The world's z axis points up.
  MotionState at(double time_s) const;

  // 1 while moving, 0 in stops.
  MotionValue moving(double time_s) const;

 private:
  Eigen::Quaterniond attitude(long stop) const;
  MotionState turning(double time_s) const;  // from attitude to attitude

  DriveMotion motion_;
  std::array<std::vector<MotionSinusoid>, 3> wobble_, sway_;
};

}  // namespace evical
