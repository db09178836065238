// Camera intrinsics in YAML: Evical's map, and the formats of Kalibr, ROS and eKalibr.
#pragma once

#include "core/base/yaml_node.h"

#include "core/data/lens_uncertainty.h"
#include "core/geometry/camera_intrinsics.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Evical's map (model, resolution_px, focal_length_px, principal_point_px, distortion), one camera of a
// Kalibr camchain, a ROS camera_info, or an OAK's calibration (its first camera). Without a resolution in the
// map it is unknown. Throws CalibrationError (BadInput).
CameraIntrinsics readIntrinsics(const YamlNode& map);

// Names of the cameras of a Kalibr camchain, cam0, cam1, ...; empty for other files.
std::vector<std::string> camchainCameras(const YamlNode& root);

// True if a file's root has the keys of one of the layouts above, except camchains and results.
bool isLens(const YamlNode& root);

// A file of intrinsics: YAML or JSON, or ost.txt of ROS's camera_calibration, converted to the keys of
// camera_info.
YamlNode loadIntrinsics(const std::filesystem::path& file);

// Keys of a lens in another layout that are not used, and their meaning, as notes for people.
std::vector<std::string> leftOutOf(const YamlNode& lens);

// From a file: any of these, a map with the key `intrinsics`, or a result.yaml. If the file has several
// cameras, the one with this name or this stream (rostopic).
CameraIntrinsics readIntrinsicsFile(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream);

// The same with the file's uncertainty: results of `evical intrinsics` and `evical calibrate` have one.
struct KnownIntrinsics {
  CameraIntrinsics camera;
  std::optional<LensUncertainty> uncertainty;
};
KnownIntrinsics readKnownIntrinsics(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream);

// Evical's map of sigmas (focal_length_px, principal_point_px, distortion), and rows of correlations between
// this camera's numbers; and the YAML text of both, with the keys of a session.
LensUncertainty readLensUncertainty(const YamlNode& sigmas, const std::optional<YamlNode>& correlation,
                                    const CameraIntrinsics& camera);
std::string lensUncertaintyYaml(const LensUncertainty& uncertainty, const CameraIntrinsics& camera,
                                int indent);

// Evical's map, one key per line, each indented by `indent` blanks.
std::string intrinsicsYaml(const CameraIntrinsics& camera, int indent);

}  // namespace evical
