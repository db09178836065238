// Rotations in YAML: x, y, z, w.
#pragma once

#include "core/base/yaml_node.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>

namespace evical {

// From the node's numbers; rounding errors are accepted. Throws CalibrationError (BadInput) at the node.
Eigen::Quaterniond unitQuaternion(const YamlNode& node, const Eigen::Vector4d& xyzw,
                                  const std::string& advice = {});

}  // namespace evical
