// A scenario of IMUs alone becomes a log in a folder: recording.bag (or one of another format), truth.yaml, the result
// of the calibration that the IMUs had before anything changed (calibration/result.yaml), trajectory.csv where asked for.
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/report/result_yaml.h"
#include "core/synthetic/drive_scenario.h"

#include <filesystem>
#include <string>

namespace evical {

// The folder is made if need be; truth.yaml comes last. `session` of the summary is the old result.
SimulationSummary simulateDrive(const DriveScenario& scenario, const std::filesystem::path& folder,
                                const RunContext& context, const std::string& format_name = {});

// What a calibration had said of the IMUs before all steps, with sigmas as one has them.
NamedResult calibrationBefore(const DriveScenario& scenario);

}  // namespace evical
