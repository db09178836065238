// Source: uzh-rpg/rpg_svo_pro_open: vikit/vikit_cameras/src/ncamera_yaml_serialization.cpp and
// camera_yaml_serialization.cpp (at 372ab39), and imu_handler.cpp (loadCalibrationFromFile,
// loadInitializationFromFile); uzh-rpg/rpg_ultimate_slam_open:
// common/ze_cameras/src/camera_yaml_serialization.cpp and camera_rig.cpp (at cf674f5), flags of
// vio_ceres_backend_interface.cpp, frontend_base.cpp and data_provider_factory.cpp. Both read the same rig.
#include "core/base/error.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <sstream>

namespace evical {
namespace {

std::vector<double> columnOf(const YamlNode& node) {
  const Eigen::MatrixXd column = matrixOf(node, 4, 1);
  return {column.data(), column.data() + 4};
}

CameraIntrinsics svoLensOf(const YamlNode& camera) {
  camera["type"].choice({"pinhole"});
  const YamlNode distortion = camera["distortion"];
  const std::size_t type = distortion["type"].choice({"radial-tangential", "equidistant", "none"});
  constexpr int kLargest_px = 100000;
  return lensFrom(
      type == 1 ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan,
      columnOf(camera["intrinsics"]), type == 2 ? std::vector<double>(4) : columnOf(distortion["parameters"]),
      {camera["image_width"].integer(1, kLargest_px), camera["image_height"].integer(1, kLargest_px)});
}

ReadFile readRig(const std::filesystem::path& path, const YamlNode& root) {
  ReadFile file{path};
  root["label"].text();
  for (const YamlNode& entry : root["cameras"].items()) {
    ReadCamera camera;
    camera.lens = svoLensOf(entry["camera"]);
    entry["camera"]["label"].text();
    camera.frame_from_camera = rigidFrom(matrixOf(entry["T_B_C"], 4, 4), entry["T_B_C"].place());
    file.cameras.push_back(camera);
  }
  if (file.cameras.empty()) throw root["cameras"].error("is empty");
  return file;
}

Eigen::Vector3d svoVectorOf(const YamlNode& node) {
  const std::vector<double> three = node.reals(3);
  return {three[0], three[1], three[2]};
}

// Flags of a --flagfile; gflags ends the program for unknown flags.
std::map<std::string, double> flagsOf(const std::filesystem::path& path) {
  std::map<std::string, double> flags;
  for (const char* known : {"timeshift_cam_imu", "swe_imu_rate", "gyro_noise_density", "acc_noise_density",
                            "vio_ceres_sigma_gyro_drift", "vio_ceres_sigma_accel_drift", "vio_ceres_gravity",
                            "vio_acc_bias_init_x", "vio_acc_bias_init_y", "vio_acc_bias_init_z",
                            "vio_gyr_bias_init_x", "vio_gyr_bias_init_y", "vio_gyr_bias_init_z"})
    flags[known] = std::nan("");
  std::istringstream text(textOf(path));
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    const std::string place = fmt::format("{} (line {})", path.string(), number);
    if (line.empty() || line.starts_with('#')) continue;
    const std::size_t equals = line.find('=');
    if (!line.starts_with("--") || equals == std::string::npos) throw badInput(place, "is not --flag=value");
    const auto found = flags.find(line.substr(2, equals - 2));
    if (found == flags.end())
      throw badInput(place, fmt::format("{} is not a flag of the program", line.substr(0, equals)));
    const char* const begin = line.data() + equals + 1;
    const char* const end = line.data() + line.size();
    const auto [stop, error] = std::from_chars(begin, end, found->second);
    if (error != std::errc{} || stop != end)
      throw badInput(place, fmt::format("'{}' is not a number", begin));
  }
  for (const auto& [name, value] : flags)
    if (std::isnan(value)) throw badInput(path.string(), fmt::format("--{} is missing", name));
  return flags;
}

}  // namespace

ReadFile readSvoFile(const std::filesystem::path& path) {
  const YamlNode root = YamlNode::load(path);
  ReadFile file = readRig(path, root);
  const std::vector<YamlNode> entries = root["cameras"].items();
  for (std::size_t i = 0; i < entries.size(); ++i)
    file.cameras[i].name = entries[i]["camera"]["label"].text();
  return file;
}

ReadBack readSvo(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "calib.yaml";
  const YamlNode root = YamlNode::load(path);
  ReadFile file = readRig(path, root);
  const YamlNode node = root["imu_params"], start = root["imu_initialization"];
  // svo's imu_handler.cpp: t_imu = t_cam - delay_imu_cam.
  file.cameras.front().time_offset_s = -node["delay_imu_cam"].real();
  for (const char* key : {"max_imu_delta_t", "acc_max", "omega_max"}) node[key].real();
  ReadImu imu;
  imu.noise = {node["sigma_omega_c"].real(), node["sigma_acc_c"].real(), node["sigma_omega_bias_c"].real(),
               node["sigma_acc_bias_c"].real()};
  imu.rate_hz = node["imu_rate"].real();
  imu.gyroscope_bias_rad_s = svoVectorOf(start["omega_bias"]);
  imu.accelerometer_bias_m_s2 = svoVectorOf(start["acc_bias"]);
  svoVectorOf(start["velocity"]);
  for (const char* key : {"velocity_sigma", "omega_bias_sigma", "acc_bias_sigma"}) start[key].real();
  file.imus = {imu};
  file.gravity_m_s2 = node["g"].real();
  ReadBack read;
  read.max_imus = 1;
  read.files = {file};
  return read;
}

ReadBack readUltimateSlam(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "calib.yaml";
  const YamlNode root = YamlNode::load(path);
  ReadFile rig = readRig(path, root);
  // frontend_api.cpp: "Missing DVS camera, but events were requested."
  const std::vector<YamlNode> cameras = root["cameras"].items();
  const auto isDvs = [](const YamlNode& camera) { return camera["camera"]["label"].text() == "dvs"; };
  if (std::none_of(cameras.begin(), cameras.end(), isDvs))
    throw cameras.front()["camera"]["label"].error("must be dvs, unless another camera has this label");
  ReadFile file{folder / "imu.flags"};
  std::map<std::string, double> flags = flagsOf(file.path);
  // camera_imu_synchronizer_base.cpp shifts images only; a topic determines whose images, which a comment
  // states.
  const std::string text = textOf(file.path);
  constexpr std::string_view kImages = "the images of ";
  if (const std::size_t at = text.find(kImages); at != std::string::npos) {
    const std::size_t begin = at + kImages.size();
    ReadCamera images;
    images.name = text.substr(begin, text.find_first_of(".\n", begin) - begin);
    images.time_offset_s = flags["timeshift_cam_imu"];
    file.cameras = {images};
  } else if (flags["timeshift_cam_imu"] != 0.0) {
    throw badInput(file.path.string(), "timeshift_cam_imu shifts images, but the rig has no frame camera");
  }
  ReadImu imu;
  imu.noise = {flags["gyro_noise_density"], flags["acc_noise_density"], flags["vio_ceres_sigma_gyro_drift"],
               flags["vio_ceres_sigma_accel_drift"]};
  imu.rate_hz = flags["swe_imu_rate"];
  imu.accelerometer_bias_m_s2 = Eigen::Vector3d(flags["vio_acc_bias_init_x"], flags["vio_acc_bias_init_y"],
                                                flags["vio_acc_bias_init_z"]);
  imu.gyroscope_bias_rad_s = Eigen::Vector3d(flags["vio_gyr_bias_init_x"], flags["vio_gyr_bias_init_y"],
                                             flags["vio_gyr_bias_init_z"]);
  file.imus = {imu};
  file.gravity_m_s2 = flags["vio_ceres_gravity"];
  ReadBack read;
  read.max_imus = 1;
  read.files = {rig, file};
  return read;
}

}  // namespace evical
