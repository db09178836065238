// Camera intrinsics in YAML: our own map, and what Kalibr, ROS and eKalibr write.
#pragma once

#include "core/base/yaml_node.h"

#include "core/data/lens_uncertainty.h"
#include "core/geometry/camera_intrinsics.h"

#include <filesystem>
#include <optional>
#include <string>

namespace evical {

// Our map (model, resolution_px, focal_length_px, principal_point_px, distortion), one
// camera of a Kalibr camchain, or a ROS camera_info; resolution from the map or, absent
// there, unknown. Throws CalibrationError (BadInput).
CameraIntrinsics readIntrinsics(const YamlNode& map);

// From a file: any of these, a map with the key `intrinsics`, or a result.yaml. Where the file has several
// cameras, the one with this name or this stream (rostopic).
CameraIntrinsics readIntrinsicsFile(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream);

// The same with what the file says of how sure it is: results of `evical intrinsics` and `evical calibrate` do.
struct KnownIntrinsics {
  CameraIntrinsics camera;
  std::optional<LensUncertainty> uncertainty;
};
KnownIntrinsics readKnownIntrinsics(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream);

// Our map of sigmas (focal_length_px, principal_point_px, distortion), and rows of correlations between the numbers
// that this camera has; and both as they are written, under the keys that a session has for them.
LensUncertainty readLensUncertainty(const YamlNode& sigmas, const std::optional<YamlNode>& correlation,
                                    const CameraIntrinsics& camera);
std::string lensUncertaintyYaml(const LensUncertainty& uncertainty, const CameraIntrinsics& camera,
                                int indent);

// Our map, one key a line, each indented by `indent` blanks.
std::string intrinsicsYaml(const CameraIntrinsics& camera, int indent);

}  // namespace evical
