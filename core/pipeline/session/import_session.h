// Sessions from what people have already: an eKalibr configuration, or Kalibr's target, IMU and camera files.
// Recognised by content. What a session has no place for is said in notes.
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
  std::string from;                 // kalibr, ekalibr, ros; empty: as their content says
  std::filesystem::path recording;  // empty: as the files say
  std::optional<double> radius_m;   // of the circles; absent: as the files say
};

struct ImportedSession {
  Session session;
  std::vector<std::string> notes;
};

// Throws CalibrationError (BadInput) for files that are none of these, twice the same, or that together do
// not make a session: no recording, no board, no camera.
ImportedSession importSession(const ImportRequest& request);

struct ImportedFiles {
  std::vector<FileContent> files;
  std::vector<std::string> notes;
};

// What `evical import` writes: the session as `output`; or, where all files hold camera intrinsics alone,
// Evical's intrinsics, one file a camera ("left.yaml", of several "left-cam0.yaml", ...).
ImportedFiles importFiles(const ImportRequest& request, const std::filesystem::path& output);

}  // namespace evical
