// Source: VladyslavUsenko/basalt-headers: include/basalt/serialization/headers_serialization.h (at 2ae558c)
// and calibration/calib_bias.hpp (at 2f26c68: getCalibrated). cereal looks up each name, and throws if it is
// missing.
#include "core/foreign/json_node.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace evical {
namespace {

// `unit`: tolerated deviation of a quaternion's norm from 1; files for import may be rounded.
RigidTransform basaltPoseOf(const JsonNode& node, double unit) {
  const auto number = [&](const char* key) { return node[key].number(); };
  const RigidTransform pose{{number("qw"), number("qx"), number("qy"), number("qz")},
                            {number("px"), number("py"), number("pz")}};
  if (std::abs(pose.rotation.norm() - 1.0) > unit) node.fail("does not have a unit quaternion");
  return pose;
}

int sideOf(const JsonNode& node) {
  const auto side_px = static_cast<double>(node.integer());
  if (!isSide_px(side_px)) node.fail("must be a whole number of pixels above 0");
  return static_cast<int>(side_px);
}

CameraIntrinsics basaltLensOf(const JsonNode& node, const JsonNode& resolution) {
  const std::string type = node["camera_type"].text();
  constexpr std::array kTypes = {
      std::pair{"kb4", CameraModel::PinholeEquidistant}, std::pair{"ds", CameraModel::DoubleSphere},
      std::pair{"eucm", CameraModel::Eucm}, std::pair{"pinhole", CameraModel::PinholeRadtan},
      std::pair{"pinhole-radtan8", CameraModel::PinholeRadtan}};
  const auto known =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& each) { return type == each.first; });
  if (known == kTypes.end())
    node["camera_type"].fail("is '" + type + "'; supported are kb4, ds, eucm, pinhole and pinhole-radtan8");
  const CameraModel model = known->second;
  const JsonNode numbers = node["intrinsics"];
  std::vector<double> k, distortion;
  for (const char* key : {"fx", "fy", "cx", "cy"}) k.push_back(numbers[key].number());
  const auto names = distortionNames(model);
  for (std::size_t i = 0; i < static_cast<std::size_t>(coefficientCount(model)); ++i)
    distortion.push_back(type == "pinhole" ? 0.0 : numbers[names[i]].number());
  for (const char* key : {"k4", "k5", "k6"})
    if (type == "pinhole-radtan8" && numbers[key].number() != 0.0)
      numbers[key].fail(
          "is not 0: rational lens models are not supported (at most three radial coefficients)");
  const std::vector<JsonNode> size = resolution.items();
  if (size.size() != 2) resolution.fail("must have two numbers");
  return lensFrom(model, k, distortion, {sideOf(size[0]), sideOf(size[1])});
}

double oneOfThree(const JsonNode& node) {
  const std::vector<double> three = node.numbers(3);
  if (three[0] != three[1] || three[0] != three[2]) node.fail("differs from axis to axis");
  return three[0];
}

// corrected = (I + S) raw - b: measured = (I + S)^-1 (true + b).
ReadImu basaltImuOf(const JsonNode& value) {
  const std::vector<double> a = value["calib_accel_bias"].numbers(9),
                            g = value["calib_gyro_bias"].numbers(12);
  Eigen::Matrix3d accelerometer = Eigen::Matrix3d::Identity(), gyroscope = Eigen::Matrix3d::Identity();
  accelerometer.col(0) += Eigen::Vector3d(a[3], a[4], a[5]);
  accelerometer(1, 1) += a[6];
  accelerometer(2, 1) += a[7];
  accelerometer(2, 2) += a[8];
  for (Eigen::Index i = 0; i < 9; ++i) gyroscope(i % 3, i / 3) += g[static_cast<std::size_t>(3 + i)];
  ReadImu imu;
  imu.accelerometer = accelerometer.inverse();
  imu.gyroscope = gyroscope.inverse();
  imu.accelerometer_bias_m_s2 = *imu.accelerometer * Eigen::Vector3d(a[0], a[1], a[2]);
  imu.gyroscope_bias_rad_s = *imu.gyroscope * Eigen::Vector3d(g[0], g[1], g[2]);
  imu.noise = {oneOfThree(value["gyro_noise_std"]), oneOfThree(value["accel_noise_std"]),
               oneOfThree(value["gyro_bias_std"]), oneOfThree(value["accel_bias_std"])};
  imu.rate_hz = value["imu_update_rate"].number();
  return imu;
}

ReadFile basaltCamerasOf(const std::filesystem::path& path, const JsonNode& value, double unit) {
  ReadFile file{path};
  const std::vector<JsonNode> poses = value["T_imu_cam"].items(), lenses = value["intrinsics"].items(),
                              sizes = value["resolution"].items();
  if (lenses.size() != poses.size() || sizes.size() != poses.size())
    value["intrinsics"].fail("does not have the length of T_imu_cam and resolution");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ReadCamera camera;
    camera.lens = basaltLensOf(lenses[i], sizes[i]);
    camera.frame_from_camera = basaltPoseOf(poses[i], unit);
    file.cameras.push_back(camera);
  }
  file.time_step_s = 1e-9;
  return file;
}

ReadFile basaltFile(const std::filesystem::path& path) {
  constexpr double kUnit = 1e-9;
  const JsonNode value = JsonNode::load(path)["value0"];
  ReadFile file = basaltCamerasOf(path, value, kUnit);
  if (!file.cameras.empty())
    file.cameras.front().time_offset_s = 1e-9 * static_cast<double>(value["cam_time_offset_ns"].integer());
  file.imus = {basaltImuOf(value)};
  value["vignette"].items();
  return file;
}

}  // namespace

ReadFile readBasaltFile(const std::filesystem::path& path) {
  const JsonNode value = JsonNode::load(path)["value0"];
  constexpr double kRounded = 1e-2;
  ReadFile file = basaltCamerasOf(path, value, kRounded);
  if (value.has("calib_accel_bias")) file.imus.emplace_back();  // so that a note says that it is not imported
  if (!value.has("camera_names")) return file;
  const std::vector<JsonNode> names = value["camera_names"].items();
  for (std::size_t i = 0; i < std::min(names.size(), file.cameras.size()); ++i)
    file.cameras[i].name = names[i].text();
  return file;
}

ReadBack readBasalt(const std::filesystem::path& folder) {
  ReadBack read;
  read.max_imus = 1;
  read.files = {basaltFile(folder / "calibration.json")};
  return read;
}

// TUM-VIE's own program is Basalt; further requirements on its file are those of get_camera_calib_json of
// tub-rip/ES-PTAM (mapper_emvs_stereo/src/calib.cpp, at 79ef978): kb4, and event cameras at 2 and 3. The
// names are Evical's addition.
ReadBack readTumVie(const std::filesystem::path& folder) {
  constexpr std::size_t kCameras = 4;
  ReadBack read;
  read.max_imus = 1;
  ReadFile file = basaltFile(folder / "camera-calibrationA.json");
  const JsonNode value = JsonNode::load(file.path)["value0"];
  const std::vector<JsonNode> names = value["camera_names"].items();
  if (file.cameras.size() != kCameras || names.size() != kCameras)
    value["T_imu_cam"].fail("must have four cameras");
  std::set<std::string> different;
  for (std::size_t i = 0; i < kCameras; ++i) {
    file.cameras[i].name = names[i].text();
    different.insert(file.cameras[i].name);
    if (file.cameras[i].lens->model != CameraModel::PinholeEquidistant)
      value["intrinsics"].items()[i]["camera_type"].fail("must be kb4");
  }
  read.max_cameras = different.size();
  read.files = {file};
  return read;
}

}  // namespace evical
