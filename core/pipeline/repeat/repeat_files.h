// Files of a repeat: repeat.yaml, repeat.csv, report.html with its tables, log.txt, session and result.yaml
// of the joint solution; and a folder for each recording (folderOf) with the files of a calibration.
#pragma once

#include "core/pipeline/repeat/repeat_calibration.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace evical {

// Throws CalibrationError (BadInput) if the folder contains a calibration, which would be overwritten.
void checkRepeatFolder(const std::filesystem::path& folder);

std::filesystem::path folderOf(const std::filesystem::path& folder, const RepeatInput& input,
                               std::size_t recording);

// Writes all files except the recordings' folders, together or not at all. Without a joint result an older
// one is removed.
void writeRepeatFiles(const std::filesystem::path& folder, const RepeatInput& input, const RepeatRun& repeat,
                      const std::string& log);

// Repeat with files in `folder`, written after each recording: a stopped repeat keeps the finished ones.
// `log`: all messages so far. Throws as checkRepeatFolder and repeatCalibration; a new folder is removed
// again if nothing was written.
RepeatRun repeatInto(const std::filesystem::path& folder, const RepeatInput& input,
                     const std::string& version, const std::function<std::string()>& log,
                     const RunContext& context);

}  // namespace evical
