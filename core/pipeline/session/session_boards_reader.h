// A session's `board` or `boards`.
#pragma once

#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"

#include <filesystem>

namespace evical {

// After the cameras, of which the reference says which board is the world. Files are beside the session, in `folder`.
// Throws CalibrationError (BadInput, with file, key and line).
void readBoards(const YamlNode& root, const std::filesystem::path& folder, Session& session);

}  // namespace evical
