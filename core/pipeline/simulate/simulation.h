// Simulates a scenario as a recording in a folder: recording.bag (or another format), session.yaml,
// truth.yaml.
#pragma once

#include "core/base/progress.h"
#include "core/data/event.h"
#include "core/report/result_yaml.h"
#include "core/synthetic/drive_scenario.h"
#include "core/synthetic/scenario.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace evical {

struct SimulationSummary {
  std::uint64_t events = 0, frames = 0, imu_samples = 0;
  std::filesystem::path recording, session, truth;
};

// Creates the folder if necessary. session.yaml and truth.yaml are written last, after the complete
// recording. The format is one of recordingFormats(); empty: the scenario's.
SimulationSummary simulate(const Scenario& scenario, const std::filesystem::path& folder,
                           const RunContext& context, const std::string& format_name = {});

// Events of all event cameras of a scenario as one stream in time order, with one thread per camera.

// Calls `sink` in the caller's thread with packets of about 10 ms; rethrows exceptions of `sink` and the
// simulations.
void simulateCameras(const Scenario& scenario,
                     const std::function<void(std::size_t camera, EventSpan events)>& sink,
                     const RunContext& context);

// Simulates a scenario with IMUs only as a log in a folder: recording.bag (or another format), truth.yaml,
// the IMUs' calibration before any change (calibration/result.yaml), and trajectory.csv if requested.

// Creates the folder if necessary; truth.yaml is written last. `session` of the summary is the old result.
SimulationSummary simulateDrive(const DriveScenario& scenario, const std::filesystem::path& folder,
                                const RunContext& context, const std::string& format_name = {});

// Calibration of the IMUs before all steps, with typical sigmas.
NamedResult calibrationBefore(const DriveScenario& scenario);

}  // namespace evical
