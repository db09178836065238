// Camera intrinsics in YAML: our own map, and what Kalibr, ROS and eKalibr write.
#pragma once

#include "core/base/yaml_node.h"

#include "core/geometry/camera_intrinsics.h"

#include <filesystem>
#include <string>

namespace evical {

const char* cameraModelName(CameraModel model);

// Our map (model, resolution_px, focal_length_px, principal_point_px, distortion), one
// camera of a Kalibr camchain, or a ROS camera_info; resolution from the map or, absent
// there, unknown. Throws CalibrationError (BadInput).
CameraIntrinsics readIntrinsics(const YamlNode& map);

// From a file: any of these, a map with the key `intrinsics`, or a result.yaml. Where the file has several
// cameras, the one with this name or this stream (rostopic).
CameraIntrinsics readIntrinsicsFile(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream);

// Our map, one key a line, each indented by `indent` blanks.
std::string intrinsicsYaml(const CameraIntrinsics& camera, int indent);

}  // namespace evical
