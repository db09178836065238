// What a repeat leaves in its folder: repeat.yaml, repeat.csv, report.html with its tables, log.txt, the session and
// result.yaml of all recordings together; and a folder for each recording (folderOf), as a calibration leaves it.
#pragma once

#include "core/pipeline/repeat/repeat_calibration.h"

#include <filesystem>
#include <functional>
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

// A repeat whose files appear in `folder`, of each recording as soon as it is done: one that is stopped keeps what was
// done until then. `log`: all that was said so far. Throws as checkRepeatFolder and repeatCalibration; a folder that was
// made for it goes away again where nothing came of it.
RepeatRun repeatInto(const std::filesystem::path& folder, const RepeatInput& input,
                     const std::string& version, const std::function<std::string()>& log,
                     const RunContext& context);

}  // namespace evical
