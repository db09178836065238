// Measurements of a drive's IMUs, and its trajectory.
#pragma once

#include "core/data/imu_sample.h"
#include "core/synthetic/drive_scenario.h"

#include <string>
#include <vector>

namespace evical {

// Stamps on the IMU's own clock, nanoseconds in the scenario's epoch; SI units.
std::vector<ImuSample> simulateDriveImu(const DriveScenario& scenario, std::size_t imu);

// trajectory.csv as a calibration writes it, with noise; empty unless the scenario asks for one.
std::string driveTrajectoryCsv(const DriveScenario& scenario);

}  // namespace evical
