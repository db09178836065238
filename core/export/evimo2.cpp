#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"

#include <fmt/format.h>

namespace evical {
namespace {

constexpr const char* kEvimo2Program = "EVIMO2";
constexpr KnownModels kEvimo2Models{kEvimo2Program, true, false, true};

// res_x is the number of rows, res_y that of columns.
std::string parametersText(const RigCamera& camera, const CameraIntrinsics& own) {
  const std::string stream = camera.stream.empty() ? "/" + camera.file_name : camera.stream;
  return fmt::format("res_x: {}\nres_y: {}\ndist_model: {}\nros_{}_topic: {}\n", own.resolution_px.height_px,
                     own.resolution_px.width_px,
                     own.model == CameraModel::PinholeRadtan ? "radtan" : "equidistant",
                     camera.kind == CameraKind::Frames ? "image" : "event", stringIn(Language::Text, stream));
}

std::string numbersLine(const std::vector<double>& numbers) {
  std::string line;
  for (const double number : numbers) line += (line.empty() ? "" : " ") + real(number);
  return line + "\n";
}

std::string evimo2LensText(const CameraIntrinsics& own) {
  std::vector<double> numbers{own.focal_length_px.x(), own.focal_length_px.y(), own.principal_point_px.x(),
                              own.principal_point_px.y()};
  for (const double coefficient : distortionOf(own, 4)) numbers.push_back(coefficient);
  return numbersLine(numbers);
}

// The camera in the rig; a room scan, which does not exist here; the offset from times of the rig to those of
// the camera; the offset from times of images to those of events, which are equal here.
std::string placeEvimo2Text(const RigCamera& camera) {
  const RigidTransform& place = camera.reference_from_camera;
  const Eigen::Vector3d rpy = rollPitchYaw(place.rotation.toRotationMatrix());
  const Eigen::Vector3d& p = place.translation_m;
  return numbersLine({p.x(), p.y(), p.z(), rpy.x(), rpy.y(), rpy.z()}) +
         numbersLine({0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}) + numbersLine({-camera.time_offset_s}) +
         numbersLine({0.0});
}

}  // namespace

ExportedFiles exportEvimo2(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const std::string reference =
      rig.imus.empty() ? "the reference camera's" : fmt::format("that of {}", rig.imus.front().name);
  for (const RigCamera& camera : rig.cameras) {
    const CameraIntrinsics own = cameraFor(camera, kEvimo2Models, exported.notes);
    const std::filesystem::path folder = camera.file_name;
    exported.files.push_back({folder / "params.txt", parametersText(camera, own)});
    exported.files.push_back({folder / "calib.txt", evimo2LensText(own)});
    exported.files.push_back({folder / "extrinsics.txt", placeEvimo2Text(camera)});
  }
  noteLostImus(rig, kEvimo2Program, exported.notes);
  for (const RigImu& imu : rig.imus) noteLostMapping(imu, kEvimo2Program, exported.notes);
  exported.notes.push_back(fmt::format(
      "{}'s rig has the frame of its motion capture markers; here it is {}: multiply it by the markers' pose",
      kEvimo2Program, reference));
  std::vector<std::string> lines{
      "One folder per camera. extrinsics.txt: x y z roll pitch yaw transform points of the camera to the "
      "rig; its third line is t_camera - t_rig.",
      "params.txt: res_x is the number of rows. ros_pos_topic, the markers' poses, must be set by the user."};
  lines.insert(lines.end(), exported.notes.begin(), exported.notes.end());
  exported.files.push_back({"README.txt", readMe(rig, lines)});
  return exported;
}

}  // namespace evical
