// Files of a check: check.yaml, report.html with its tables, log.txt. They are written together or not at
// all.
#pragma once

#include "core/pipeline/check/check_calibration.h"

#include <filesystem>
#include <string>

namespace evical {

void writeCheckFiles(const std::filesystem::path& folder, const CheckInput& input, const CheckRun& checked,
                     const std::string& version, const std::string& log);

}  // namespace evical
