// Source: uzh-rpg/DSEC's README.md (at 0df8d87), and programs that read it: compute_remapping of
// uzh-rpg/dsec-det (src/dsec_det/remapping.py, at db941c2), get_camera_calib_dsec_yaml of tub-rip/ES-PTAM
// (mapper_emvs_stereo/src/calib.cpp, at 79ef978). camera_name is Evical's addition.
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include "core/base/error.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <array>

namespace evical {
namespace {

constexpr int kLargest_px = 100000;
constexpr double kSame = 1e-9;

Resolution dsecSizeOf(const YamlNode& camera) {
  const std::vector<YamlNode> size = camera["resolution"].items();
  if (size.size() != 2) throw camera["resolution"].error("must have two numbers");
  return {size[0].integer(1, kLargest_px), size[1].integer(1, kLargest_px)};
}

void checkKind(const YamlNode& camera, std::size_t place, const char* rectified) {
  static_cast<void>(camera["camera_type"].choice({place % 3 == 0 ? "event" : "frame"}));
  static_cast<void>(camera["camera_location"].choice({place < 2 ? "left" : "right"}));
  static_cast<void>(camera["is_rectified"].choice({rectified}));
  static_cast<void>(camera["camera_model"].choice({"pinhole"}));
}

Eigen::Matrix3d matrixOf(const YamlNode& camera) {
  const std::vector<double> k = camera["camera_matrix"].reals(4);
  return (Eigen::Matrix3d() << k[0], 0.0, k[2], 0.0, k[1], k[3], 0.0, 0.0, 1.0).finished();
}

Eigen::Matrix3d turnOfRow(const YamlNode& extrinsics, std::size_t place) {
  const YamlNode node = extrinsics[fmt::format("R_rect{}", place)];
  const Eigen::MatrixXd rows = rowsOf(node, 3, 3);
  if (!((rows * rows.transpose() - Eigen::Matrix3d::Identity()).norm() < kSame))
    throw node.error("is not a rotation");
  return rows;
}

// After rectification, the right camera is displaced along x, and Q reconstructs a point from its disparity.
void checkPair(const YamlNode& root, std::size_t left, std::size_t right,
               const RigidTransform& right_from_left) {
  const YamlNode node = root["disparity_to_depth"][fmt::format("cams_{}{}", left, right)];
  const YamlNode cameras = root["intrinsics"], extrinsics = root["extrinsics"];
  const Eigen::Matrix4d q = rowsOf(node, 4, 4);
  const Eigen::Matrix3d of_left = turnOfRow(extrinsics, left), of_right = turnOfRow(extrinsics, right),
                        k_left = matrixOf(cameras[fmt::format("camRect{}", left)]),
                        k_right = matrixOf(cameras[fmt::format("camRect{}", right)]);
  const Eigen::Vector3d on_left(0.2, -0.3, 2.0);
  const Eigen::Vector3d on_right = of_right * (right_from_left * (of_left.transpose() * on_left));
  const Eigen::Vector2d a = (k_left * on_left).hnormalized(), b = (k_right * on_right).hnormalized();
  const Eigen::Vector3d back = (q * Eigen::Vector4d(a.x(), a.y(), a.x() - b.x(), 1.0)).hnormalized();
  if (!(std::abs(a.y() - b.y()) < 1e-6) || !((back - on_left).norm() < kSame))
    throw node.error("does not reconstruct a point from its disparity");
}

CameraIntrinsics dsecLensOf(const YamlNode& camera) {
  const YamlNode model = camera["distortion_model"];
  const bool equidistant = model.choice({"radtan", "equidistant"}) == 1;
  return lensFrom(equidistant ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan,
                  camera["camera_matrix"].reals(4), camera["distortion_coeffs"].reals(4), dsecSizeOf(camera));
}

ReadCamera dsecCameraOf(const YamlNode& root, std::size_t place) {
  const YamlNode own = root["intrinsics"][fmt::format("cam{}", place)],
                 level = root["intrinsics"][fmt::format("camRect{}", place)];
  checkKind(own, place, "false");
  checkKind(level, place, "true");
  if (dsecSizeOf(own) != dsecSizeOf(level)) throw level["resolution"].error("differs from the camera's");
  static_cast<void>(own["distortion_model"].choice({"radtan"}));
  static_cast<void>(matrixOf(level));
  static_cast<void>(turnOfRow(root["extrinsics"], place));
  ReadCamera camera;
  camera.name = own["camera_name"].text();
  camera.lens = dsecLensOf(own);
  return camera;
}

}  // namespace

ReadFile readDsecFile(const std::filesystem::path& path) {
  ReadFile file{path};
  const YamlNode root = YamlNode::load(path), cameras = root["intrinsics"];
  for (const std::string& key : cameras.keys()) {
    if (!key.starts_with("cam") || key.find_first_not_of("0123456789", 3) != std::string::npos) continue;
    ReadCamera& camera = file.cameras.emplace_back();
    camera.name = key;
    camera.lens = dsecLensOf(cameras[key]);
    if (root.has("extrinsics")) camera.frame_from_camera = RigidTransform{};
  }
  return file;
}

ReadBack readDsec(const std::filesystem::path& folder) {
  constexpr std::size_t kPlaces = 4;
  ReadFile file{folder / "cam_to_cam.yaml", {}, {}, true};
  const YamlNode root = YamlNode::load(file.path), extrinsics = root["extrinsics"];
  std::array<std::optional<RigidTransform>, kPlaces> this_from_first;
  RigidTransform here;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    if (i > 0 && !root["intrinsics"].has(fmt::format("cam{}", i))) {
      if (const auto step = extrinsics.find(fmt::format("T_{}{}", i, i - 1)))
        here = rigidFrom(rowsOf(*step, 4, 4), step->place()) * here;
      continue;
    }
    if (i > 0) {
      const YamlNode step = extrinsics[fmt::format("T_{}{}", i, i - 1)];
      here = rigidFrom(rowsOf(step, 4, 4), step.place()) * here;
    }
    this_from_first[i] = here;
    file.cameras.push_back(dsecCameraOf(root, i));
    file.cameras.back().frame_from_camera = inverse(here);
  }
  if (this_from_first[3]) checkPair(root, 0, 3, *this_from_first[3]);
  if (this_from_first[1] && this_from_first[2])
    checkPair(root, 1, 2, *this_from_first[2] * inverse(*this_from_first[1]));
  ReadBack read;
  read.max_cameras = file.cameras.size();
  read.max_imus = 0;
  read.files = {file};
  return read;
}

}  // namespace evical
