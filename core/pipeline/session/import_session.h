// Sessions from existing files: an eKalibr configuration, or Kalibr's target, IMU and camera files,
// recognised by content. Notes list contents that a session cannot represent.
#pragma once

#include "core/base/atomic_file.h"
#include "core/pipeline/session/session.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct ImportRequest {
  std::vector<std::filesystem::path> files;
  std::string from;                 // kalibr, ekalibr, ros; empty: from their content
  std::filesystem::path recording;  // empty: from the files
  std::optional<double> radius_m;   // of the circles; absent: from the files
};

struct ImportedSession {
  Session session;
  std::vector<std::string> notes;
};

// Reads the files and returns the session that they describe; writes nothing.
// Throws CalibrationError (BadInput) for files of another kind, duplicates, or an incomplete session: no
// recording, no board, no camera.
ImportedSession importSession(const ImportRequest& request);

struct ImportedFiles {
  std::vector<FileContent> files;
  std::vector<std::string> notes;
};

// Contents of the files that `evical import` writes: the session as `output`; or, if all files have only camera intrinsics,
// Evical's intrinsics, one file per camera ("left.yaml"; for several "left-cam0.yaml", ...).
ImportedFiles importFiles(const ImportRequest& request, const std::filesystem::path& output);

}  // namespace evical
