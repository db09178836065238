// What a repeat leaves in its folder: repeat.yaml, repeat.csv, report.html with its tables, log.txt, the session and
// result.yaml of all recordings together; and a folder for each recording (folderOf), as a calibration leaves it.
#pragma once

#include "core/pipeline/repeat_calibration.h"

#include <filesystem>
#include <memory>
#include <string>

namespace evical {

// Throws CalibrationError (BadInput) where the folder holds a calibration of its own, which would be lost.
void checkRepeatFolder(const std::filesystem::path& folder);

std::filesystem::path folderOf(const std::filesystem::path& folder, const RepeatInput& input,
                               std::size_t recording);

// All but the recordings' folders, together or not at all. Without a joint result an older one goes.
void writeRepeatFiles(const std::filesystem::path& folder, const RepeatInput& input, const RepeatRun& repeat,
                      const std::string& log);

}  // namespace evical
