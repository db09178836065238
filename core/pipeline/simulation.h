// A scenario becomes a recording in a folder: recording.bag (or events.txt and imu.txt), session.yaml,
// truth.yaml.
#pragma once

#include "core/base/progress.h"
#include "core/synthetic/scenario.h"

#include <cstdint>
#include <filesystem>

namespace evical {

struct SimulationSummary {
  std::uint64_t events = 0, imu_samples = 0;
  std::filesystem::path recording, session, truth;
};

// The folder is made if need be. session.yaml and truth.yaml come last, when the recording is whole.
SimulationSummary simulate(const Scenario& scenario, const std::filesystem::path& folder,
                           const RunContext& context);

}  // namespace evical
