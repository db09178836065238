// Session with its recording replaced by another one of the same rig.
#pragma once

#include "core/pipeline/session/session.h"

#include <filesystem>

namespace evical {

// By its extension: YAML is a session, anything else a recording.
bool isSessionFile(const std::filesystem::path& path);

// Sets the recording and removes settings that depend on the old one. Throws CalibrationError (BadInput) if
// sensors have separate recordings, which one file cannot replace.
void setRecording(const std::filesystem::path& recording, Session& session);

}  // namespace evical
