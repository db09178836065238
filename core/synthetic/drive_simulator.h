// What the IMUs of a drive measure, and what a trajectory of it says.
#pragma once

#include "core/data/imu_sample.h"
#include "core/synthetic/drive_scenario.h"

#include <string>
#include <vector>

namespace evical {

// Stamps on the IMU's own clock, nanoseconds in the scenario's epoch; SI units.
std::vector<ImuSample> simulateDriveImu(const DriveScenario& scenario, std::size_t imu);

// trajectory.csv as a calibration writes it, with noise; empty where none is asked for.
std::string driveTrajectoryCsv(const DriveScenario& scenario);

}  // namespace evical
