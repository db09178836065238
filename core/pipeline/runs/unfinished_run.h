// Files of a run without a result: the reason, if this does not overwrite an earlier result.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

#include <filesystem>
#include <string>

namespace evical {

// `folder_was_there`: before this run. A failed run writes the reason. A cancelled run removes a folder that
// it has created; a run with bad input writes nothing.
void writeUnfinishedRun(const std::filesystem::path& folder, bool folder_was_there, const Session& session,
                        const CalibrationOutcome& outcome, const std::string& version,
                        const std::string& log);

}  // namespace evical
