// Source: introlab/rtabmap, corelib/src/CameraModel.cpp (at 191e165: CameraModel::load),
// corelib/src/StereoCameraModel.cpp (at 4d44b61: load) and corelib/src/Transform.cpp (fromString).
#include "core/base/error.h"
#include "core/foreign/opencv_file.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <cmath>
#include <sstream>
#include <system_error>

namespace evical {
namespace {

// Other shapes stop the program (UASSERT).
Eigen::MatrixXd matrixAt(const OpencvFile& file, const char* key, int rows, int cols) {
  const OpencvNode node = file[key];
  if (node["rows"].integer() != rows || node["cols"].integer() != cols)
    node.fail(fmt::format("must have {} rows and {} columns", rows, cols));
  return matrixFrom(node["data"].numbers(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols)),
                    rows, cols);
}

struct CameraModelFile {
  ReadCamera camera;  // frame_from_camera: to the base
  Eigen::Matrix3d rectification;
  Eigen::MatrixXd projection;
};

CameraModelFile readRtabmapCamera(const std::filesystem::path& path) {
  const OpencvFile file(path);
  CameraModelFile read;
  read.camera.name = file["camera_name"].text();
  const Resolution size{file["image_width"].integer(), file["image_height"].integer()};
  const Eigen::Matrix3d k = matrixAt(file, "camera_matrix", 3, 3);
  const bool fisheye = file["distortion_model"].text().find("equidistant") != std::string::npos;
  const int count = fisheye ? 4 : 5;
  const Eigen::RowVectorXd d = matrixAt(file, "distortion_coefficients", 1, count);
  read.camera.lens = lensFrom(fisheye ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan,
                              {k(0, 0), k(1, 1), k(0, 2), k(1, 2)}, {d.begin(), d.end()}, size);
  read.rectification = matrixAt(file, "rectification_matrix", 3, 3);
  read.projection = matrixAt(file, "projection_matrix", 3, 4);
  const OpencvNode pose = file["local_transform"];
  read.camera.frame_from_camera = rigidFrom(matrixAt(file, "local_transform", 3, 4), pose.place());
  return read;
}

std::vector<ReadImu> readImus(const std::filesystem::path& path) {
  std::istringstream lines(textOf(path));
  std::vector<ReadImu> imus;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with('#')) continue;
    if (colon == std::string::npos) throw badInput(path.string(), "has a line without an IMU's name");
    std::istringstream words(line.substr(colon + 2));
    std::vector<double> values;
    for (double value = 0.0; words >> value;) values.push_back(value);
    if (values.size() != 12) throw badInput(path.string(), "an IMU's transform has 12 numbers");
    ReadImu imu;
    imu.name = line.substr(0, colon);
    imu.reference_from_imu = rigidFrom(matrixFrom(values, 3, 4), path.string());
    imus.push_back(imu);
  }
  if (imus.empty()) throw badInput(path.string(), "has no IMU");
  return imus;
}

PairAsRead readRtabmapPair(const std::filesystem::path& folder) {
  const CameraModelFile left = readRtabmapCamera(folder / "stereo_left.yaml"),
                        right = readRtabmapCamera(folder / "stereo_right.yaml");
  const OpencvFile file(folder / "stereo_pose.yaml");
  file["camera_name"].text();
  matrixAt(file, "essential_matrix", 3, 3);
  matrixAt(file, "fundamental_matrix", 3, 3);
  const Eigen::MatrixXd rotation = matrixAt(file, "rotation_matrix", 3, 3),
                        translation = matrixAt(file, "translation_matrix", 3, 1);
  const Eigen::MatrixXd pose = (Eigen::MatrixXd(3, 4) << rotation, translation).finished();
  const PairAsRead pair{*left.camera.lens, *right.camera.lens,
                        rigidFrom(pose, file["rotation_matrix"].place())};
  // It uses R and P: after rectification, the cameras must differ only by the baseline along x.
  constexpr double kSame = 1e-9;
  const Eigen::Matrix3d level_from_level =
      right.rectification * pair.right_from_left.rotation * left.rectification.transpose();
  const Eigen::Vector3d baseline = right.rectification * pair.right_from_left.translation_m;
  const double by_projection_m = right.projection(0, 3) / right.projection(0, 0);
  if ((level_from_level - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kSame ||
      (baseline - Eigen::Vector3d(by_projection_m, 0.0, 0.0)).norm() > kSame)
    file["rotation_matrix"].fail("is inconsistent with the cameras' R and P");
  return pair;
}

}  // namespace

ReadBack readRtabmap(const std::filesystem::path& folder) {
  std::vector<ReadCamera> cameras;
  ReadBack read;
  for (const std::filesystem::path& path : filesLike(folder, "", ".yaml")) {
    cameras.push_back(readRtabmapCamera(path).camera);
    if (path.stem() != cameras.back().name) throw badInput(path.string(), "differs from its camera_name");
    read.files.push_back({path, {cameras.back()}});
  }
  if (cameras.empty()) throw badInput(folder.string(), "has no camera");
  std::error_code ignored;
  const std::filesystem::path imu_file = folder / "imu_local_transform.txt";
  RigidTransform reference_from_base = inverse(*cameras[0].frame_from_camera);
  const bool inertial = std::filesystem::exists(imu_file, ignored);
  if (inertial) {
    ReadFile file{imu_file, {}, readImus(imu_file)};
    reference_from_base = inverse(*file.imus[0].reference_from_imu);
    for (ReadImu& imu : file.imus) imu.reference_from_imu = reference_from_base * *imu.reference_from_imu;
    read.files.push_back(std::move(file));
  }
  const std::filesystem::path stereo = folder / "stereo";
  if (std::filesystem::exists(stereo, ignored))
    read.files.push_back(pairAmong(cameras, readRtabmapPair(stereo), stereo / "stereo_pose.yaml"));
  // Converts poses in the base to poses in the reference IMU, or in the first camera.
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    ReadFile& file = read.files[i];
    file.cameras[0].frame_from_camera = reference_from_base * *cameras[i].frame_from_camera;
    if (inertial) continue;
    file.about_first_camera = true;
    ReadCamera first;
    first.name = cameras[0].name;
    first.frame_from_camera = RigidTransform{};
    file.cameras.insert(file.cameras.begin(), first);
  }
  return read;
}

}  // namespace evical
