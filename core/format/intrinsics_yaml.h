// Camera intrinsics in YAML: Evical's map, and the formats of Kalibr, ROS and eKalibr.
#pragma once

#include "core/base/yaml_node.h"

#include "core/data/camera_lens.h"
#include "core/geometry/camera_intrinsics.h"

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace evical {

// Evical's map (model, resolution_px, focal_length_px, principal_point_px, distortion), one camera of a
// Kalibr camchain, a ROS camera_info, or one camera of an OAK's calibration. Without a resolution in the
// map it is unknown. Throws CalibrationError (BadInput); a lens of another program must also be plausible.
CameraIntrinsics readIntrinsics(const YamlNode& map);

// Throws CalibrationError (BadInput) if a lens of another program cannot be right: values outside of the
// model's range, another unit, or those of another image size. Its resolution may be unknown.
void validateImported(const CameraIntrinsics& camera, const std::string& place);

// fx, fy, cx and cy of a camera matrix, given row by row. Throws CalibrationError (BadInput) if it has a
// skew, is transposed or scaled.
std::array<double, 4> cameraMatrixNumbers(std::span<const double> matrix, const std::string& place);

// Names of the cameras of a Kalibr camchain, cam0, cam1, ...; empty for other files. Throws if the root is a
// camera itself and has others below it, since the line of the first one is missing then.
std::vector<std::string> camchainCameras(const YamlNode& root);

// The cameras of an OAK's calibration by their sockets, cam0, cam1, ..., without those that were not
// calibrated; empty for other files.
std::vector<std::pair<std::string, YamlNode>> oakCameras(const YamlNode& root);

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
