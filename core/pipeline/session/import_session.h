// Sessions from existing files: an eKalibr configuration, or Kalibr's target, IMU and camera files,
// recognised by content. Notes list contents that a session cannot represent.
#pragma once

#include "core/pipeline/session/session.h"

#include "core/base/atomic_file.h"
#include "core/base/yaml_node.h"
#include "core/foreign/lens_files.h"

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

// Contents of the files that `evical import` writes: the session as `output`; or, if all files have only
// camera intrinsics, Evical's intrinsics, one file per camera ("left.yaml"; for several "left-cam0.yaml",
// ...).
ImportedFiles importFiles(const ImportRequest& request, const std::filesystem::path& output);

// Contents of the files of an import, by program.
enum class ImportKind { EkalibrConfiguration, KalibrTarget, KalibrImu, KalibrCamchain, Intrinsics, LensFile };

struct ImportSource {
  std::filesystem::path path;
  YamlNode root;  // empty for lens files
  ImportKind kind;
  std::optional<LensFile> lenses = {};
};

// Throws CalibrationError (BadInput) if the content is of another kind.
ImportSource recogniseSource(const std::filesystem::path& path);

// Sensor names from topics: "/davis/left/events" is davis_left, and its IMU davis_left_imu; with a number if
// the name is already used.
std::string sensorName(const std::string& topic, bool imu, const Session& session);

void importEkalibr(const ImportSource& source, const ImportRequest& request, ImportedSession& imported);

// Target, IMUs and cameras, in any order.
void importKalibr(const std::vector<ImportSource>& sources, const ImportRequest& request,
                  ImportedSession& imported);

}  // namespace evical
