// Contents of the files of an import, by program.
#pragma once

#include "core/base/yaml_node.h"
#include "core/foreign/lens_files.h"
#include "core/pipeline/session/import_session.h"

#include <optional>
#include <string>
#include <vector>

namespace evical {

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
