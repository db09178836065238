// Intrinsics that were calibrated first, with all data for reports, as YAML.
#pragma once

#include "core/base/yaml_node.h"
#include "core/data/intrinsics_result.h"

#include <string>

namespace evical {

// Without the intrinsics themselves. One key per line, each indented by `indent` blanks.
std::string foundIntrinsicsYaml(const IntrinsicsResult& found, int indent);
IntrinsicsResult foundIntrinsicsFrom(const YamlNode& map, const CameraIntrinsics& intrinsics);

}  // namespace evical
