// Camera intrinsics in YAML: our own map, and what Kalibr, ROS and eKalibr write.
#pragma once

#include "core/base/yaml_node.h"

#include "core/data/lens_uncertainty.h"
#include "core/geometry/camera_intrinsics.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Our map (model, resolution_px, focal_length_px, principal_point_px, distortion), one
// camera of a Kalibr camchain, a ROS camera_info, or an OAK's calibration (its first camera); resolution from the map or,
// absent there, unknown. Throws CalibrationError (BadInput).
CameraIntrinsics readIntrinsics(const YamlNode& map);

// Names of the cameras of Kalibr's camchain, cam0, cam1, ...; none where it is no camchain.
std::vector<std::string> camchainCameras(const YamlNode& root);

// Whether a file's root has the keys of one of the layouts above, but for camchains and results.
bool isLens(const YamlNode& root);

// A file of intrinsics: YAML or JSON, or ost.txt as ROS's camera_calibration writes it, in the keys of camera_info.
YamlNode loadIntrinsics(const std::filesystem::path& file);

// Keys of a lens in a layout of others that are not taken, and what they are, as notes for people.
std::vector<std::string> leftOutOf(const YamlNode& lens);

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
