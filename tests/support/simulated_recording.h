// Recordings that several tests read. Each is simulated once in a build folder, by the first test that needs
// it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace evical::test {

// The session file of the recording with this name. `make` writes it and all required files into a folder,
// session.yaml last. Tests that change files copy them first.
std::filesystem::path simulatedOnce(const std::string& name,
                                    const std::function<void(const std::filesystem::path& folder)>& make);

// The first seconds of a scenario of config/scenarios. recording.bag and truth.yaml are in the same folder as
// the session.
std::filesystem::path simulatedRecording(const std::string& scenario, double duration_s);

}  // namespace evical::test
