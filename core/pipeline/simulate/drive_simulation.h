// Simulates a scenario with IMUs only as a log in a folder: recording.bag (or another format), truth.yaml,
// the IMUs' calibration before any change (calibration/result.yaml), and trajectory.csv if requested.
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/report/result_yaml.h"
#include "core/synthetic/drive_scenario.h"

#include <filesystem>
#include <string>

namespace evical {

// Creates the folder if necessary; truth.yaml is written last. `session` of the summary is the old result.
SimulationSummary simulateDrive(const DriveScenario& scenario, const std::filesystem::path& folder,
                                const RunContext& context, const std::string& format_name = {});

// Calibration of the IMUs before all steps, with typical sigmas.
NamedResult calibrationBefore(const DriveScenario& scenario);

}  // namespace evical
