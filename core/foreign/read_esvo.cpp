// Source: HKUST-Aerial-Robotics/ESVO: esvo_core/src/container/CameraSystem.cpp (at 995f61b: loadCalibInfo);
// NAIL-HNU/ESVO2: esvo2_core/src/container/CameraSystem.cpp (at 2edd832) and
// image_representation/src/ImageRepresentation.cpp (at 27d2f5f), which require T_right_left and T_b_c in each
// camera's file. Size and distortion model of both cameras are the left one's, and four coefficients are
// used.
#include "core/base/error.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>
#include <Eigen/LU>

namespace evical {
namespace {

Eigen::MatrixXd esvoDataOf(const YamlNode& root, const char* key, Eigen::Index rows, Eigen::Index cols) {
  return matrixFrom(root[key]["data"].reals(static_cast<std::size_t>(rows * cols)), rows, cols);
}

RigidTransform esvoPoseOf(const YamlNode& root, const char* key) {
  return rigidFrom(esvoDataOf(root, key, 3, 4), root[key].place());
}

ReadCamera esvoCameraOf(const YamlNode& left, const YamlNode& root) {
  const bool radtan = left["distortion_model"].choice({"plumb_bob", "equidistant"}) == 0;
  constexpr int kLargest_px = 100000;
  const std::vector<double> all = root["distortion_coefficients"]["data"].reals();
  if (all.size() < 4) throw root["distortion_coefficients"]["data"].error("must have four numbers");
  const Eigen::Matrix3d k = esvoDataOf(root, "camera_matrix", 3, 3);
  ReadCamera camera;
  camera.name = root["camera_name"].text();
  camera.lens =
      lensFrom(radtan ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant,
               {k(0, 0), k(1, 1), k(0, 2), k(1, 2)}, {all.begin(), all.begin() + 4},
               {left["image_width"].integer(1, kLargest_px), left["image_height"].integer(1, kLargest_px)});
  return camera;
}

// After rectification, the right camera is displaced along x by the distance in projection_matrix.
void checkRectification(const YamlNode& left, const YamlNode& right, const RigidTransform& right_from_left) {
  constexpr double kSame = 1e-9;
  const Eigen::Matrix3d of_left = esvoDataOf(left, "rectification_matrix", 3, 3),
                        of_right = esvoDataOf(right, "rectification_matrix", 3, 3);
  const Eigen::Matrix<double, 3, 4> p_left = esvoDataOf(left, "projection_matrix", 3, 4),
                                    p_right = esvoDataOf(right, "projection_matrix", 3, 4);
  const Eigen::Matrix3d turn = of_right * right_from_left.rotation.toRotationMatrix() * of_left.transpose();
  const Eigen::Vector3d baseline = of_right * right_from_left.translation_m;
  const Eigen::Vector3d said = p_right.leftCols<3>().inverse() * p_right.col(3);
  if (!((turn - Eigen::Matrix3d::Identity()).norm() < kSame) || !((baseline - said).norm() < kSame))
    throw right["rectification_matrix"].error("does not put the cameras side by side");
  if (p_left.leftCols<3>() != p_right.leftCols<3>() || p_left.col(3) != Eigen::Vector3d::Zero())
    throw left["projection_matrix"].error("differs from that of the right camera");
}

ReadBack readEsvoPair(const std::filesystem::path& folder, bool with_imu) {
  const std::filesystem::path left_path = folder / "left.yaml", right_path = folder / "right.yaml";
  const YamlNode left = YamlNode::load(left_path), right = YamlNode::load(right_path);
  const RigidTransform right_from_left = esvoPoseOf(left, "T_right_left");
  checkRectification(left, right, right_from_left);
  ReadFile pair{left_path, {esvoCameraOf(left, left), esvoCameraOf(left, right)}, {}, true};
  pair.cameras[0].frame_from_camera = RigidTransform{};
  pair.cameras[1].frame_from_camera = inverse(right_from_left);
  ReadBack read;
  read.max_cameras = 2;
  read.max_imus = 0;
  read.files = {pair};
  if (with_imu) {
    ReadCamera camera;
    camera.name = pair.cameras[0].name;
    camera.frame_from_camera = esvoPoseOf(left, "T_b_c");
    for (const char* key : {"T_right_left", "T_b_c"}) esvoPoseOf(right, key);
    read.files.push_back({left_path, {camera}});
  }
  return read;
}

}  // namespace

ReadBack readEsvo(const std::filesystem::path& folder) {
  return readEsvoPair(folder, false);
}

ReadBack readEsvo2(const std::filesystem::path& folder) {
  return readEsvoPair(folder, true);
}

}  // namespace evical
