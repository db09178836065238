// Reader for a session's `board` or `boards`.
#pragma once

#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"

#include <filesystem>

namespace evical {

// Must run after the cameras were read, since the reference defines the world's board. Files are relative to
// `folder`. Throws CalibrationError (BadInput, with file, key and line).
void readBoards(const YamlNode& root, const std::filesystem::path& folder, Session& session);

}  // namespace evical
