// Simulated drives (config/scenarios/maintain) in the form of the estimators' inputs.
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

// Errors of the second IMU relative to the first, about the values of the calibration.
std::vector<PairWindow> pairWindows(const DriveScenario& scenario);
PairModel pairModel(const DriveScenario& scenario);
PairTrack trackOf(const DriveScenario& scenario, double alarm_probability = 0.005);

}  // namespace evical::test
