// What a run that came to no result leaves in its folder: the reason, where that takes nothing from an earlier result.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

#include <filesystem>
#include <string>

namespace evical {

// `folder_was_there`: before this run. A run that failed tells why; one that was cancelled leaves nothing in a folder of
// its own, one with bad input nowhere.
void writeUnfinishedRun(const std::filesystem::path& folder, bool folder_was_there, const Session& session,
                        const CalibrationOutcome& outcome, const std::string& version,
                        const std::string& log);

}  // namespace evical
