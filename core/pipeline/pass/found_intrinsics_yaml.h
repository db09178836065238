// Intrinsics as they were calibrated first, with all that reports tell of them, as YAML.
#pragma once

#include "core/base/yaml_node.h"
#include "core/data/intrinsics_result.h"

#include <string>

namespace evical {

// But for the intrinsics themselves. One key a line, each indented by `indent` blanks.
std::string foundIntrinsicsYaml(const IntrinsicsResult& found, int indent);
IntrinsicsResult foundIntrinsicsFrom(const YamlNode& map, const CameraIntrinsics& intrinsics);

}  // namespace evical
