#include "core/format/quantity_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {

void YamlSections::add(const std::string& section, const std::string& key, const std::string& value) {
  auto found = std::find_if(sections_.begin(), sections_.end(),
                            [&](const Section& each) { return !section.empty() && each.name == section; });
  if (found == sections_.end()) found = sections_.insert(found, {section, {}});
  found->lines.push_back(fmt::format("{}: {}\n", key, value));
}

std::string YamlSections::text(std::size_t indent) const {
  std::string text;
  for (const Section& section : sections_) {
    const std::string blanks(indent + (section.name.empty() ? 0 : 2), ' ');
    if (!section.name.empty()) text += fmt::format("{}{}:\n", std::string(indent, ' '), section.name);
    for (const std::string& line : section.lines) text += blanks + line;
  }
  return text;
}

std::string exactYaml(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0.0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}
std::string roundedYaml(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : exactYaml(value);
}

std::string quantityYaml(double value, NumberFormat format) {
  return format(value);
}
std::string quantityYaml(const Eigen::VectorXd& values, NumberFormat format) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + format(value);
  return "[" + text + "]";
}
std::string quantityYaml(const Eigen::Vector3d& value, NumberFormat format) {
  return quantityYaml(Eigen::VectorXd(value), format);
}
std::string quantityYaml(const Eigen::Quaterniond& value, NumberFormat format) {
  return quantityYaml(Eigen::VectorXd(value.coeffs()), format);
}
std::string quantityYaml(const Eigen::Matrix3d& value, NumberFormat format) {
  std::string text;
  for (int row = 0; row < 3; ++row)
    text += (row == 0 ? "" : ", ") + quantityYaml(Eigen::VectorXd(value.row(row).transpose()), format);
  return "[" + text + "]";
}

double yamlSigmaFactor(const QuantityInfo& info) {
  const bool rotation = info.shape == QuantityShape::Rotation || info.shape == QuantityShape::LocalRotation;
  return rotation ? info.shown_factor : 1.0;
}

std::optional<YamlNode> quantitySection(const YamlNode& sensor, const QuantityInfo& info) {
  return info.section == std::string() ? std::optional(sensor) : sensor.find(info.section);
}

}  // namespace evical
