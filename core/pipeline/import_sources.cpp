#include "core/pipeline/import_sources.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

bool isLens(const YamlNode& root) {
  return root.has("Intrinsics") || root.has("camera_matrix") || root.has("camera_model") || root.has("K") ||
         root.has("focal_length_px");
}

}  // namespace

ImportSource recogniseSource(const std::filesystem::path& path) {
  const YamlNode root = YamlNode::load(path);
  const auto as = [&](ImportKind kind) { return ImportSource{path, root, kind}; };
  if (root.isMap()) {
    if (root.has("Configor")) return as(ImportKind::EkalibrConfiguration);
    if (root.has("target_type")) return as(ImportKind::KalibrTarget);
    if (root.has("cam0")) return as(ImportKind::KalibrCamchain);
    if (root.has("imu0") || root.has("accelerometer_noise_density")) return as(ImportKind::KalibrImu);
    if (isLens(root)) return as(ImportKind::Intrinsics);
  }
  throw root.error("is no file that can be imported",
                   "Give an eKalibr configuration, or Kalibr's target, imu and camchain files");
}

std::string sensorName(const std::string& topic, bool imu, const Session& session) {
  // "/a/b/events" -> {a, b}: the last part says what is sent.
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
