// Session with its recording replaced by another one of the same rig.
#pragma once

#include "core/pipeline/session/session.h"

#include <filesystem>
#include <optional>

namespace evical {

// By its extension: YAML is a session, anything else a recording.
bool isSessionFile(const std::filesystem::path& path);

// Sets the recording and removes settings that depend on the old one. Throws CalibrationError (BadInput) if
// sensors have separate recordings, which one file cannot replace.
void setRecording(const std::filesystem::path& recording, Session& session);

// A file that both sessions read in overlapping time ranges; absent if they have separate data.
std::optional<std::filesystem::path> sharedRecording(const Session& a, const Session& b);

}  // namespace evical
