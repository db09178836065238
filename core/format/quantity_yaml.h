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

// Lines "key: value", some of them in sections. A section is placed where its first line was added.
class YamlSections {
 public:
  // Lines without a section's name are placed among the sections.
  void add(const std::string& section, const std::string& key, const std::string& value);
  std::string text(std::size_t indent) const;  // lines of sections are indented by two more blanks

 private:
  struct Section {
    std::string name;
    std::vector<std::string> lines;
  };
  std::vector<Section> sections_;
};

// Numbers that read back exactly, and rounded ones for sigmas. Both write .nan and .inf.
std::string exactYaml(double value);
std::string roundedYaml(double value);

using NumberFormat = std::string (*)(double);
std::string quantityYaml(double value, NumberFormat format);
std::string quantityYaml(const Eigen::VectorXd& values, NumberFormat format);
std::string quantityYaml(const Eigen::Vector3d& value, NumberFormat format);
std::string quantityYaml(const Eigen::Quaterniond& value, NumberFormat format);  // x, y, z, w
std::string quantityYaml(const Eigen::Matrix3d& value, NumberFormat format);

// Factor of a written sigma: those of rotations are in degrees.
double yamlSigmaFactor(const QuantityInfo& info);

// The map with the quantity's keys; nullopt if the section is missing.
std::optional<YamlNode> quantitySection(const YamlNode& sensor, const QuantityInfo& info);

// Keys allowed in a sensor's map (with the names of its sections), or in the section `section`.
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
