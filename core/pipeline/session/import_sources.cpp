#include "core/pipeline/session/import_sources.h"

#include "core/format/intrinsics_yaml.h"

#include <fmt/format.h>

namespace evical {

ImportSource recogniseSource(const std::filesystem::path& path) {
  if (auto lenses = readLensFile(path))
    return {path, YamlNode::parse("{}", path.string()), ImportKind::LensFile, std::move(lenses)};
  const YamlNode root = loadIntrinsics(path);
  const auto as = [&](ImportKind kind) { return ImportSource{path, root, kind}; };
  if (root.isMap()) {
    if (root.has("Configor")) return as(ImportKind::EkalibrConfiguration);
    if (root.has("target_type")) return as(ImportKind::KalibrTarget);
    if (!camchainCameras(root).empty()) return as(ImportKind::KalibrCamchain);
    if (root.has("imu0") || root.has("accelerometer_noise_density")) return as(ImportKind::KalibrImu);
    if (isLens(root)) return as(ImportKind::Intrinsics);
  }
  throw root.error(
      root.isMap() && root.has("evical_session") ? "is already a session"
                                                 : "has no layout that can be imported",
      "Give an eKalibr configuration; Kalibr's target, imu and camchain files; or intrinsics of " +
          lensLayouts());
}

std::string sensorName(const std::string& topic, bool imu, const Session& session) {
  // "/a/b/events" -> {a, b}: the last part is the type of the messages.
  std::vector<std::string> parts(1);
  for (const char letter : topic) {
    if (letter != '/') {
      parts.back() += letter;
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.back().empty() && parts.size() > 1) parts.pop_back();
  if (parts.size() > 1) parts.pop_back();
  std::string name;
  for (const std::string& part : parts) name += (name.empty() ? "" : "_") + part;
  if (imu) name += "_imu";
  if (name.empty()) name = "camera";
  std::string unique = name;
  for (int number = 2; isSensorName(session, unique); ++number) unique = fmt::format("{}_{}", name, number);
  return unique;
}

}  // namespace evical
