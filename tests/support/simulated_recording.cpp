#include "tests/support/simulated_recording.h"

#include "core/base/file_places.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/test_folders.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

namespace evical::test {

std::filesystem::path simulatedOnce(const std::string& name,
                                    const std::function<void(const std::filesystem::path& folder)>& make) {
  const std::filesystem::path folder = buildPath("tests/simulated/" + name);
  std::filesystem::create_directories(folder);
  FileLock lock(folder / "lock");
  while (!lock.tryAgain()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const std::filesystem::path session = folder / "recording" / "session.yaml";
  if (!std::filesystem::exists(session)) {
    std::filesystem::create_directories(session.parent_path());
    make(session.parent_path());
  }
  return session;
}

std::filesystem::path simulatedRecording(const std::string& name, double duration_s) {
  return simulatedOnce(fmt::format("{}_{}s", name, duration_s), [&](const std::filesystem::path& folder) {
    Scenario scenario = readScenario(scenarioPath(name));
    scenario.duration_s = duration_s;
    simulate(scenario, folder, {});
  });
}

}  // namespace evical::test
