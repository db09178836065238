// Simulated drives (config/scenarios/maintain) as the estimators take them.
#pragma once

#include "core/maintenance/maintenance_options.h"
#include "core/maintenance/pair_tracking.h"
#include "core/maintenance/stop_calibration.h"
#include "core/synthetic/drive_scenario.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical::test {

DriveScenario driveScenario(const std::string& name, std::uint64_t seed = 1);

WindowMeans meansOf(const DriveScenario& scenario, std::size_t imu = 0);
StopCalibration stopsOf(const DriveScenario& scenario, const MaintenanceOptions& options = {});

// Of the second IMU against the first, about what the calibration had said of them.
std::vector<PairWindow> pairWindows(const DriveScenario& scenario);
PairModel pairModel(const DriveScenario& scenario);
PairTrack trackOf(const DriveScenario& scenario, double alarm_probability = 0.005);

}  // namespace evical::test
