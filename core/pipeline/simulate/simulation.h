// Simulates a scenario as a recording in a folder: recording.bag (or another format), session.yaml,
// truth.yaml.
#pragma once

#include "core/base/progress.h"
#include "core/synthetic/scenario.h"

#include <cstdint>
#include <filesystem>
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

}  // namespace evical
