#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr const char* kDsecProgram = "DSEC";
constexpr KnownModels kDsecModels{kDsecProgram, true, false, false};

// DSEC's cameras: 0 and 3 are the event cameras, left and right, 1 and 2 the frame cameras.
struct Place {
  const char* type;
  const char* location;
  std::optional<RigCamera> camera = {};
  CameraIntrinsics lens = {};  // in a model that DSEC supports
  Eigen::Matrix3d rectified_from_camera = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d rectified = Eigen::Matrix3d::Identity();  // camera matrix
};
using Places = std::array<Place, 4>;

Places placesOf(const DataSetCameras& cameras, ExportNotes& notes) {
  Places places{Place{"event", "left", cameras.left_event}, Place{"frame", "left", cameras.left_frame},
                Place{"frame", "right", cameras.right_frame}, Place{"event", "right", cameras.right_event}};
  for (Place& place : places)
    if (place.camera) place.lens = cameraFor(*place.camera, kDsecModels, notes);
  return places;
}

RigidTransform fromTo(const RigCamera& from, const RigCamera& to) {
  return inverse(to.reference_from_camera) * from.reference_from_camera;
}

// Rectifies pairs; for a single camera only the distortion is removed.
void rectifyPair(Place& left, Place& right) {
  if (!left.camera) return;
  left.rectified = cameraMatrix(left.lens);
  if (!right.camera) return;
  const Rectification rectified = rectify(left.lens, right.lens, fromTo(*left.camera, *right.camera));
  left.rectified_from_camera = rectified.rectified_from_left;
  right.rectified_from_camera = rectified.rectified_from_right;
  left.rectified = rectified.left_projection.leftCols<3>();
  right.rectified = rectified.right_projection.leftCols<3>();
}

std::string matrixList(const Eigen::Matrix3d& k) {
  return realList(std::vector<double>{k(0, 0), k(1, 1), k(0, 2), k(1, 2)});
}

std::string headText(const Place& place, std::size_t i, bool rectified) {
  return fmt::format(
      "  cam{}{}:\n    camera_type: {}\n    camera_location: {}\n    is_rectified: {}\n    camera_model: "
      "pinhole\n"
      "    resolution: [{}, {}]\n",
      rectified ? "Rect" : "", i, place.type, place.location, rectified, place.lens.resolution_px.width_px,
      place.lens.resolution_px.height_px);
}

// Empty for the first camera, and if the previous one is missing.
std::string dsecChainText(const Places& places, std::size_t i) {
  if (i == 0 || !places[i - 1].camera) return "";
  return "    T_cn_cnm1:\n" + rowsYaml(matrixOf(fromTo(*places[i - 1].camera, *places[i].camera)), 4);
}

std::string dsecCameraText(const Places& places, std::size_t i) {
  const Place& place = places[i];
  return headText(place, i, false) +
         fmt::format("    camera_name: {}\n", stringIn(Language::Yaml, place.camera->name)) +
         dsecChainText(places, i) +
         fmt::format("    distortion_model: radtan\n    distortion_coeffs: [{}]\n    camera_matrix: [{}]\n",
                     realList(distortionOf(place.lens, 4)), matrixList(cameraMatrix(place.lens))) +
         headText(place, i, true) + fmt::format("    camera_matrix: [{}]\n", matrixList(place.rectified));
}

// Programs chain the transforms, T_32 T_21 T_10: a missing camera is replaced by the one before it.
std::string extrinsicsText(const Places& places) {
  std::string text = "extrinsics:\n", skipped;
  const RigCamera* before = &*places[0].camera;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const RigCamera* const here = places[i].camera ? &*places[i].camera : before;
    skipped += fmt::format("  T_{}{}:{}\n", i, i - 1,
                           here == before ? fmt::format("  # there is no cam{}", i) : "") +
               rowsYaml(matrixOf(fromTo(*before, *here)), 2);
    if (here != before) text += std::exchange(skipped, {});
    before = here;
  }
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].camera)
      text += fmt::format("  R_rect{}:\n", i) + rowsYaml(places[i].rectified_from_camera, 2);
  return text;
}

// Matrix from (column, row, disparity, 1) in the left rectified image to a point in homogeneous coordinates.
std::string disparityText(const char* key, const Place& left, const Place& right) {
  if (!left.camera || !right.camera) return "";
  const double baseline_m = fromTo(*left.camera, *right.camera).translation_m.norm();
  Eigen::Matrix4d q = Eigen::Matrix4d::Zero();
  q(0, 0) = q(1, 1) = 1.0;
  q(0, 3) = -left.rectified(0, 2);
  q(1, 3) = -left.rectified(1, 2);
  q(2, 3) = left.rectified(0, 0);
  q(3, 2) = 1.0 / baseline_m;
  return fmt::format("  {}:\n", key) + rowsYaml(q, 2);
}

}  // namespace

ExportedFiles exportDsec(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  Places places = placesOf(dataSetCameras(rig, kDsecProgram, exported.notes), exported.notes);
  rectifyPair(places[0], places[3]);
  rectifyPair(places[1], places[2]);
  noteNoOffsets(rig, kDsecProgram, exported.notes);
  if (!rig.imus.empty())
    exported.notes.push_back(
        fmt::format("{} has no IMUs: {} is in other targets' files", kDsecProgram, rig.imus.front().name));
  std::vector<std::string> comment{
      "DSEC's cam_to_cam.yaml. T_XY transforms points of camera Y to camera X, R_rectX points of camera X to "
      "camRectX.",
      "There is no cam_to_lidar.yaml: Evical calibrates no LiDAR."};
  comment.insert(comment.end(), exported.notes.begin(), exported.notes.end());
  std::string text = headerComment(rig, comment) + "intrinsics:\n";
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].camera) text += dsecCameraText(places, i);
  text += extrinsicsText(places);
  const std::string disparity =
      disparityText("cams_03", places[0], places[3]) + disparityText("cams_12", places[1], places[2]);
  if (!disparity.empty()) text += "disparity_to_depth:\n" + disparity;
  exported.files.push_back({"cam_to_cam.yaml", text});
  return exported;
}

}  // namespace evical
