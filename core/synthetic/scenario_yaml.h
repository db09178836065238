// Scenarios as files, and the files with a simulated recording: its truth and a matching session.
#pragma once

#include "core/synthetic/scenario.h"

#include <filesystem>
#include <string>

namespace evical {

// Absent keys keep the defaults of scenario.h; `base:` names a scenario that this one modifies.
// `camera` and `imu` are maps for the first of each, `cameras` and `imus` lists for several. Unknown keys and
// values out of range are BadInput with file, key and line.
Scenario readScenario(const std::filesystem::path& path);

// The keys of result.yaml with the true values. time_offset_s is the value of a perfect estimator: the
// clocks' offset minus the pixels' delay; both are written next to it.
std::string truthYaml(const Scenario& scenario);

// Folder of frame cameras' pictures, next to the recording: with one folder per camera, named after its
// stream.
inline constexpr const char* kFramesFolder = "frames";

// A session for the recording `recording_file` in the same folder. `imu_file`: the file of the IMUs; empty if
// the recording includes them.
std::string sessionYaml(const Scenario& scenario, const std::string& recording_file,
                        const std::string& imu_file = {});

}  // namespace evical
