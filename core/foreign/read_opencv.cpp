// Source: opencv/opencv, samples/cpp/tutorial_code/calib3d/camera_calibration/camera_calibration.cpp and
// samples/cpp/stereo_calib.cpp (at aa2dde3), and opencv/opencv_contrib,
// modules/ccalib/samples/omni_calibration.cpp: matrices are read with >> cv::Mat.
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/foreign/opencv_file.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"
#include "core/format/intrinsics_yaml.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

namespace evical {
namespace {

std::vector<double> cameraNumbersOf(const OpencvNode& node) {
  const std::array<double, 4> numbers = cameraMatrixNumbers(node.matrixNumbers(), node.place());
  return {numbers.begin(), numbers.end()};
}

// A column of 5 for cv::projectPoints, of 4 for cv::fisheye's and, in addition to xi, for cv::omnidir's.
CameraIntrinsics opencvLensOf(const OpencvFile& file, const char* k_key, const char* d_key,
                              const char* xi_key, Resolution size) {
  file[k_key].matrix(3, 3);
  const std::vector<double> intrinsics = cameraNumbersOf(file[k_key]);
  const bool omni = file.has(xi_key);
  const bool radtan = !omni && file[d_key]["rows"].integer() == 5;
  const Eigen::VectorXd d = file[d_key].matrix(radtan ? 5 : 4, 1);
  if (radtan) return lensFrom(CameraModel::PinholeRadtan, intrinsics, {d.begin(), d.end()}, size);
  if (!omni) return lensFrom(CameraModel::PinholeEquidistant, intrinsics, {d.begin(), d.end()}, size);
  return lensFrom(CameraModel::OmniRadtan, intrinsics,
                  {file[xi_key].matrix(1, 1)(0, 0), d[0], d[1], d[2], d[3]}, size);
}

RigidTransform poseAt(const OpencvFile& file, const char* key) {
  return rigidFrom(file[key].matrix(4, 4), file[key].place());
}

ReadCamera opencvCameraOf(const OpencvFile& file, const std::string& name) {
  ReadCamera camera;
  camera.name = name;
  camera.lens = opencvLensOf(file, "camera_matrix", "distortion_coefficients", "xi",
                             {file["image_width"].integer(), file["image_height"].integer()});
  if ((file["fisheye_model"].integer() != 0) != (camera.lens->model == CameraModel::PinholeEquidistant))
    file["fisheye_model"].fail("does not match the distortion_coefficients");
  file["avg_reprojection_error"].number();
  camera.frame_from_camera = poseAt(file, "reference_from_camera");
  camera.time_offset_s = file["time_offset_s"].number();
  return camera;
}

ReadImu opencvImuOf(const OpencvFile& file, const std::string& name) {
  ReadImu imu;
  imu.name = name;
  imu.reference_from_imu = poseAt(file, "reference_from_imu");
  imu.time_offset_s = file["time_offset_s"].number();
  imu.accelerometer = file["accelerometer_matrix"].matrix(3, 3);
  imu.gyroscope = file["gyroscope_matrix"].matrix(3, 3);
  imu.accelerometer_bias_m_s2 = file["accelerometer_bias"].matrix(3, 1);
  imu.gyroscope_bias_rad_s = file["gyroscope_bias"].matrix(3, 1);
  imu.rate_hz = file["rate_hz"].number();
  imu.noise = {file["gyroscope_noise_density"].number(), file["accelerometer_noise_density"].number(),
               file["gyroscope_random_walk"].number(), file["accelerometer_random_walk"].number()};
  return imu;
}

PairAsRead readOpencvPair(const std::filesystem::path& folder) {
  const OpencvFile in(folder / "intrinsics.yml"), ex(folder / "extrinsics.yml");
  const Eigen::MatrixXd rotation = ex["R"].matrix(3, 3), translation = ex["T"].matrix(3, 1);
  const Eigen::MatrixXd pose = (Eigen::MatrixXd(3, 4) << rotation, translation).finished();
  const PairAsRead pair{opencvLensOf(in, "M1", "D1", "xi1", {}), opencvLensOf(in, "M2", "D2", "xi2", {}),
                        rigidFrom(pose, ex["R"].place())};
  for (const char* const key : {"E", "F"}) ex[key].matrix(3, 3);
  ex["Q"].matrix(4, 4);
  // After rectification, the cameras differ only by the baseline along x.
  constexpr double kSame = 1e-9;
  const Eigen::Matrix3d r1 = ex["R1"].matrix(3, 3), r2 = ex["R2"].matrix(3, 3);
  const Eigen::MatrixXd p2 = ex["P2"].matrix(3, 4);
  const Eigen::Vector3d baseline = r2 * pair.right_from_left.translation_m;
  ex["P1"].matrix(3, 4);
  if ((r2 * pair.right_from_left.rotation * r1.transpose() - Eigen::Matrix3d::Identity()).norm() > kSame ||
      (baseline - Eigen::Vector3d(p2(0, 3) / p2(0, 0), 0.0, 0.0)).norm() > kSame)
    ex["R"].fail("is inconsistent with R1, R2 and P2");
  return pair;
}

// Key names for a camera's matrices, image size and fisheye flag.
struct OpencvKeys {
  const char *k, *d, *xi;
};
constexpr OpencvKeys kOpencvKeys[] = {{"camera_matrix", "distortion_coefficients", "xi"},
                                      {"cameraMatrix", "distCoeffs", "xi"},
                                      {"Camera_Matrix", "Distortion_Coefficients", "xi"},
                                      {"K", "D", "xi"},
                                      {"mtx", "dist", "xi"},
                                      {"K1", "D1", "xi1"},
                                      {"K2", "D2", "xi2"},
                                      {"M1", "D1", "xi1"},
                                      {"M2", "D2", "xi2"}};

Resolution opencvSizeOf(const OpencvNode& node) {
  for (const auto& [width, height] : {std::pair{"image_width", "image_height"},
                                      std::pair{"image_Width", "image_Height"}, std::pair{"width", "height"}})
    if (node.has(width) && node.has(height)) return {node[width].side_px(), node[height].side_px()};
  for (const char* key : {"image_size", "imageSize", "resolution"})
    if (node.has(key)) return node[key].resolution();
  return {};
}

// DV's newer files name the model, and always have the flag 0.
std::optional<bool> saysFisheye(const OpencvNode& node) {
  if (node.has("distortion_model")) {
    std::string model = node["distortion_model"].text();
    std::ranges::transform(model, model.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const auto& [name, fisheye] :
         {std::pair{"radialtangential", false}, std::pair{"plumb_bob", false}, std::pair{"radtan", false},
          std::pair{"pinhole", false}, std::pair{"equidistant", true}, std::pair{"fisheye", true}})
      if (model == name) return fisheye;
    node["distortion_model"].fail("is '" + model + "', which is not supported");
  }
  for (const char* key : {"fisheye_model", "use_fisheye_model", "fisheye"}) {
    if (!node.has(key)) continue;
    if (!node[key].isText()) return node[key].number() != 0.0;
    const std::string text = node[key].text();
    for (const auto& [name, fisheye] :
         {std::pair{"1", true}, std::pair{"true", true}, std::pair{"True", true}, std::pair{"0", false},
          std::pair{"false", false}, std::pair{"False", false}})
      if (text == name) return fisheye;
    node[key].fail("must be 0 or 1");
  }
  return std::nullopt;
}

// Coefficients in any shape: k1 k2 p1 p2, k3, and those of the rational model, which must be 0.
CameraIntrinsics opencvLensAt(const OpencvNode& node, const OpencvKeys& keys, std::optional<bool> fisheye,
                              Resolution size) {
  const std::vector<double> intrinsics = cameraNumbersOf(node[keys.k]);
  std::vector<double> d = node[keys.d].matrixNumbers();
  constexpr std::size_t kRadtan = 5, kFisheye = 4;
  if (node.has(keys.xi)) {
    if (d.size() != kFisheye) node[keys.d].fail("must have four numbers in addition to xi");
    d.insert(d.begin(), node[keys.xi].matrixNumbers().front());
    return lensFrom(CameraModel::OmniRadtan, intrinsics, d, size);
  }
  if (fisheye.value_or(false)) {
    if (d.size() != kFisheye) node[keys.d].fail("must have four numbers for a fisheye lens");
    return lensFrom(CameraModel::PinholeEquidistant, intrinsics, d, size);
  }
  if (d.size() == kFisheye && !fisheye) node[keys.d].fail("fits two lens models: add fisheye_model: 1 or 0");
  if (d.size() < kFisheye) node[keys.d].fail("must have four or five numbers");
  if (std::any_of(d.begin() + static_cast<std::ptrdiff_t>(std::min(d.size(), kRadtan)), d.end(),
                  [](double each) { return each != 0.0; }))
    node[keys.d].fail("is a rational lens model, which is not supported (at most three radial coefficients)");
  return lensFrom(CameraModel::PinholeRadtan, intrinsics, d, size);
}

// `root`: provides flag and size for cameras without their own.
void addOpencvCameras(const OpencvNode& root, const OpencvNode& node, const std::string& name,
                      ReadFile& file) {
  for (const OpencvKeys& keys : kOpencvKeys) {
    if (!node.has(keys.k)) continue;
    if (!node.has(keys.d)) node[keys.k].fail(std::string("has no distortion: ") + keys.d + " is missing");
    ReadCamera& camera = file.cameras.emplace_back();
    camera.name = name.empty() && std::isdigit(static_cast<unsigned char>(keys.k[1])) ? keys.k : name;
    const Resolution own_size = opencvSizeOf(node);
    const std::optional<bool> own_flag = saysFisheye(node);
    camera.lens = opencvLensAt(node, keys, own_flag ? own_flag : saysFisheye(root),
                               own_size.known() ? own_size : opencvSizeOf(root));
    if (root.has("R") && root.has("T"))
      camera.frame_from_camera = RigidTransform{};  // a note states that it is not imported
  }
}

}  // namespace

// At the root, or below the camera's name (DV).
ReadFile readOpencvFile(const std::filesystem::path& path) {
  const OpencvFile opened(path);
  ReadFile file{path};
  const OpencvNode root = opened.root();
  addOpencvCameras(root, root, "", file);
  for (const std::string& key : root.keys())
    if (root.has(key) && !opened[key].keys().empty()) addOpencvCameras(root, opened[key], key, file);
  return file;
}

ReadBack readOpenCv(const std::filesystem::path& folder) {
  ReadBack read;
  std::vector<ReadCamera> cameras;
  for (const std::filesystem::path& path : filesLike(folder, "", ".yaml")) {
    const OpencvFile file(path);
    ReadFile one{path};
    if (file.has("reference_from_imu"))
      one.imus.push_back(opencvImuOf(file, path.stem().string()));
    else
      one.cameras.push_back(opencvCameraOf(file, path.stem().string()));
    cameras.insert(cameras.end(), one.cameras.begin(), one.cameras.end());
    read.files.push_back(std::move(one));
  }
  if (pathExists(folder / "intrinsics.yml") || pathExists(folder / "extrinsics.yml"))
    read.files.push_back(pairAmong(cameras, readOpencvPair(folder), folder / "extrinsics.yml"));
  return read;
}

}  // namespace evical
