#include "core/base/yaml_node.h"
#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

namespace evical {
namespace {

constexpr const char* kRtabmapProgram = "RTAB-Map";
constexpr KnownModels kRtabmapModels{kRtabmapProgram, true, true, true};

using Projection = Eigen::Matrix<double, 3, 4>;

// The base frame has x forward and z up, and a single camera has this pose in it
// (CameraModel::opticalRotation).
RigidTransform baseFromOptical() {
  Eigen::Matrix3d turn;
  turn << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return {Eigen::Quaterniond(turn), Eigen::Vector3d::Zero()};
}

// The base is at `first`, so that this camera's local_transform is the program's default.
RigidTransform baseFrom(const RigCamera& first) {
  return baseFromOptical() * inverse(first.reference_from_camera);
}

std::string rtabmapMatrixText(const char* key, const Eigen::MatrixXd& matrix) {
  return fmt::format("{}:\n", key) + dataMatrix(matrix, 3);
}

std::string rtabmapCameraFile(const Rig& rig, const std::string& name, const CameraIntrinsics& own,
                              const Eigen::Matrix3d& rectification, const Projection& projection,
                              const RigidTransform& base_from_camera) {
  return "%YAML:1.0\n---\n" +
         headerComment(
             rig,
             {"Camera of RTAB-Map. local_transform transforms points of the camera to the base, which is at "
              "the first (left) camera, x forward, z up.",
              stampShifts(rig)}) +
         cameraInfoBody(name, own, 5) + rtabmapMatrixText("rectification_matrix", rectification) +
         rtabmapMatrixText("projection_matrix", projection) +
         rtabmapMatrixText("local_transform", matrixOf(base_from_camera).topRows<3>());
}

std::string poseFile(const Rig& rig, const std::string& name, const CameraIntrinsics& left,
                     const CameraIntrinsics& right, const RigidTransform& right_from_left) {
  return "%YAML:1.0\n---\n" +
         headerComment(
             rig,
             {"Stereo pair of RTAB-Map. rotation_matrix and translation_matrix transform points of the left "
              "camera to the right one."}) +
         fmt::format("camera_name: \"{}\"\n", name) +
         rtabmapMatrixText("rotation_matrix", right_from_left.rotation.toRotationMatrix()) +
         rtabmapMatrixText("translation_matrix", right_from_left.translation_m) +
         rtabmapMatrixText("essential_matrix", essentialMatrix(right_from_left)) +
         rtabmapMatrixText("fundamental_matrix", fundamentalMatrix(left, right, right_from_left));
}

// In a separate folder, since a camera may have the name of one of its files.
void addRtabmapPair(const Rig& rig, const StereoPair& pair, const CameraIntrinsics& left,
                    const CameraIntrinsics& right, std::vector<FileContent>& files) {
  const Rectification rectified = rectify(left, right, pair.right_from_left);
  const RigidTransform base_from_left = baseFrom(pair.left) * pair.left.reference_from_camera;
  // Both have the left camera's pose: the pair's pose and P of the right one determine the rest, as in the
  // program.
  files.push_back(
      {"stereo/stereo_left.yaml", rtabmapCameraFile(rig, "stereo_left", left, rectified.rectified_from_left,
                                                    rectified.left_projection, base_from_left)});
  files.push_back({"stereo/stereo_right.yaml",
                   rtabmapCameraFile(rig, "stereo_right", right, rectified.rectified_from_right,
                                     rectified.right_projection, base_from_left)});
  files.push_back({"stereo/stereo_pose.yaml", poseFile(rig, "stereo", left, right, pair.right_from_left)});
}

// Twelve numbers, row by row: the format of Transform::fromString and of its settings.
std::string imuTransforms(const Rig& rig, const RigidTransform& base_from_reference) {
  std::string text;
  for (const RigImu& imu : rig.imus) {
    const Eigen::Matrix4d pose = matrixOf(base_from_reference * imu.state.reference_from_imu);
    std::string numbers;
    for (int row = 0; row < 3; ++row)
      for (int col = 0; col < 4; ++col) numbers += (numbers.empty() ? "" : " ") + real(pose(row, col));
    text += fmt::format("{}: {}\n", imu.file_name, numbers);
  }
  return text;
}

}  // namespace

ExportedFiles exportRtabmap(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const std::optional<StereoPair> pair = sideBySide(rig);
  const RigidTransform base_from_reference = baseFrom(pair ? pair->left : rig.cameras[0]);
  std::vector<CameraIntrinsics> lenses;
  for (const RigCamera& camera : rig.cameras) {
    const CameraIntrinsics& own = lenses.emplace_back(cameraFor(camera, kRtabmapModels, exported.notes));
    Projection projection = Projection::Zero();
    projection.leftCols<3>() = cameraMatrix(own);
    exported.files.push_back(
        {camera.file_name + ".yaml",
         rtabmapCameraFile(rig, camera.file_name, own, Eigen::Matrix3d::Identity(), projection,
                           base_from_reference * camera.reference_from_camera)});
  }
  if (pair) {
    const bool swapped = pair->left.name != rig.cameras[0].name;
    addRtabmapPair(rig, *pair, lenses[swapped ? 1 : 0], lenses[swapped ? 0 : 1], exported.files);
  } else if (rig.cameras.size() > 1) {
    exported.notes.push_back(
        fmt::format("{} and {} are not side by side: files of a stereo pair are not written",
                    rig.cameras[0].name, rig.cameras[1].name));
  }
  if (!rig.imus.empty()) {
    for (const RigImu& imu : rig.imus) noteLostMapping(imu, kRtabmapProgram, exported.notes);
    exported.files.push_back(
        {"imu_local_transform.txt",
         imuTransforms(rig, base_from_reference) +
             headerComment(
                 rig, {"The local transform of an IMU takes its points to the base: 12 numbers for the "
                       "program's settings (x y z roll pitch yaw and 7 numbers are its other forms)."})});
  }
  if (!rig.imus.empty() || rig.cameras.size() > 1) exported.notes.push_back(stampShifts(rig));
  return exported;
}

}  // namespace evical
