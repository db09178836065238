// A scenario becomes a recording in a folder: recording.bag (or one
// of another format), session.yaml, truth.yaml.
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

// The folder is made if need be. session.yaml and truth.yaml come last, when the recording is whole. The
// format is one of recordingFormats(); empty: the scenario's.
SimulationSummary simulate(const Scenario& scenario, const std::filesystem::path& folder,
                           const RunContext& context, const std::string& format_name = {});

}  // namespace evical
