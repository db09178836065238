// Quantities as text in YAML: result.yaml, truth.yaml and a session's prior have the same keys.
#pragma once

#include "core/base/yaml_node.h"
#include "core/data/quantity.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace evical {

// Lines "key: value", some of them in sections. A section stands where the first of its lines was added.
class YamlSections {
 public:
  // Without a section's name: among the sections.
  void add(const std::string& section, const std::string& key, const std::string& value);
  std::string text(std::size_t indent) const;  // the lines of sections are two blanks further in

 private:
  struct Section {
    std::string name;
    std::vector<std::string> lines;
  };
  std::vector<Section> sections_;
};

// Numbers that read back the same; and rounded, as is enough for sigmas. Both know .nan and .inf.
std::string exactYaml(double value);
std::string roundedYaml(double value);

using NumberFormat = std::string (*)(double);
std::string quantityYaml(double value, NumberFormat format);
std::string quantityYaml(const Eigen::VectorXd& values, NumberFormat format);
std::string quantityYaml(const Eigen::Vector3d& value, NumberFormat format);
std::string quantityYaml(const Eigen::Quaterniond& value, NumberFormat format);  // x, y, z, w
std::string quantityYaml(const Eigen::Matrix3d& value, NumberFormat format);

// What a sigma is multiplied by where it is written: of rotations they are in degrees.
double yamlSigmaFactor(const QuantityInfo& info);

// Where the quantity's keys are; nothing if the section is not there.
std::optional<YamlNode> quantitySection(const YamlNode& sensor, const QuantityInfo& info);

// What may stand in a sensor's map, sections by their names, or in one of its sections.
template <class Rows>
std::vector<std::string> quantityKeys(const Rows& rows, const std::string& section = {}) {
  std::vector<std::string> keys;
  forEachQuantity(rows, [&](const auto& row) {
    if (row.info.section == section)
      keys.insert(keys.end(), {row.info.key, row.info.std_key});
    else if (section.empty())
      keys.push_back(row.info.section);
  });
  return keys;
}

}  // namespace evical
