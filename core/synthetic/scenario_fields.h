// Readers of scenario keys. They keep the value if the key is absent, so a scenario modifies its base.
#pragma once

#include "core/base/yaml_node.h"
#include "core/geometry/so3.h"

#include <fmt/format.h>
#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace evical {

inline constexpr double kAny = std::numeric_limits<double>::max();

inline void get(const YamlNode& map, const char* key, double& value, double minimum, double maximum,
                const char* unit) {
  if (const auto node = map.find(key)) value = node->real(minimum, maximum, unit);
}
inline void get(const YamlNode& map, const char* key, int& value, int minimum, int maximum) {
  if (const auto node = map.find(key)) value = node->integer(minimum, maximum);
}
inline void get(const YamlNode& map, const char* key, std::string& value) {
  const auto node = map.find(key);
  if (!node) return;
  value = node->text();
  if (value.empty()) throw node->error("must not be empty");
}
template <class Enum>
inline void get(const YamlNode& map, const char* key, Enum& value, std::initializer_list<const char*> words) {
  if (const auto node = map.find(key)) value = static_cast<Enum>(node->choice(words));
}
template <int Size>
inline void get(const YamlNode& map, const char* key, Eigen::Matrix<double, Size, 1>& value,
                double minimum = -kAny, double maximum = kAny, double unit = 1.0) {
  const auto node = map.find(key);
  if (!node) return;
  const std::vector<double> numbers = node->reals(Size);
  for (int i = 0; i < Size; ++i) {
    const double number = numbers[static_cast<std::size_t>(i)];
    if (number < minimum || number > maximum)
      throw node->error(fmt::format("{} is out of range", number),
                        fmt::format("Give numbers from {} to {}", minimum, maximum));
    value(i) = unit * number;
  }
}

// Common beginning of all kinds of scenario: its base, read by `read` (path, depth), its name, its seed.
template <class AnyScenario, class Read>
void readBeginning(const YamlNode& root, const std::filesystem::path& path, int depth, const Read& read,
                   AnyScenario& scenario) {
  if (const auto base = root.find("base")) {
    constexpr int kDeepest = 8;
    if (depth > kDeepest) throw base->error("the chain of bases has no end");
    scenario = read(path.parent_path() / base->text(), depth + 1);
  }
  scenario.name = path.stem().string();
  int seed = static_cast<int>(scenario.seed);
  get(root, "seed", seed, 0, std::numeric_limits<int>::max());
  scenario.seed = static_cast<std::uint64_t>(seed);
}

inline void readTransform(const YamlNode& map, RigidTransform& transform) {
  map.allowOnly({"rotation_xyzw", "translation_m"});
  Eigen::Vector4d rotation = transform.rotation.coeffs();
  get(map, "rotation_xyzw", rotation);
  get(map, "translation_m", transform.translation_m);
  if (rotation.norm() < 1e-6) throw map["rotation_xyzw"].error("must not be zero");
  transform.rotation.coeffs() = rotation.normalized();
}

}  // namespace evical
