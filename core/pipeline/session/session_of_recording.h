// A session whose recording is another one of the same rig.
#pragma once

#include "core/pipeline/session/session.h"

#include <filesystem>

namespace evical {

// By its name: YAML is a session, all else a recording.
bool isSessionFile(const std::filesystem::path& path);

// All that ties a session to its recording goes. Throws CalibrationError (BadInput) where sensors have recordings of
// their own, which one file cannot stand for.
void setRecording(const std::filesystem::path& recording, Session& session);

}  // namespace evical
