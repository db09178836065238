// How scenarios' keys are read: all of these leave the value alone where the key is absent, which is how a scenario
// changes its base.
#pragma once

#include "core/base/yaml_node.h"
#include "core/geometry/rigid_transform.h"

#include <fmt/format.h>
#include <Eigen/Core>

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

inline void readTransform(const YamlNode& map, RigidTransform& transform) {
  map.allowOnly({"rotation_xyzw", "translation_m"});
  Eigen::Vector4d rotation = transform.rotation.coeffs();
  get(map, "rotation_xyzw", rotation);
  get(map, "translation_m", transform.translation_m);
  if (rotation.norm() < 1e-6) throw map["rotation_xyzw"].error("must not be zero");
  transform.rotation.coeffs() = rotation.normalized();
}

}  // namespace evical
