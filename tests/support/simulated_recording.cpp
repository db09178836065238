#include "tests/support/simulated_recording.h"

#include "core/pipeline/simulation.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/test_folders.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace evical::test {
namespace {

// Other processes wait while it lives.
class LockedFolder {
 public:
  explicit LockedFolder(const std::filesystem::path& folder)
      : file_(::open((folder / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    ::flock(file_, LOCK_EX);
  }
  ~LockedFolder() { ::close(file_); }
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

 private:
  int file_;
};

}  // namespace

std::filesystem::path simulatedOnce(const std::string& name,
                                    const std::function<void(const std::filesystem::path& folder)>& make) {
  const std::filesystem::path folder = buildPath("tests/simulated/" + name);
  std::filesystem::create_directories(folder);
  const LockedFolder locked(folder);
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
