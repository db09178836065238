#include "core/data/intrinsics_yaml.h"

#include "core/base/nearest_name.h"
#include "core/geometry/camera_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace evical {
namespace {

// Enough for the largest sensors to come, and small enough that width * height fits an int.
constexpr int kMostPixels = 30000;

Eigen::Vector2d pair(const YamlNode& node) {
  const std::vector<double> values = node.reals(2);
  return {values[0], values[1]};
}

Resolution resolution(const YamlNode& node) {
  const std::vector<YamlNode> items = node.items();
  if (items.size() != 2) throw node.error("must be [width, height]");
  return {items[0].integer(1, kMostPixels), items[1].integer(1, kMostPixels)};
}

void setDistortion(const YamlNode& node, CameraIntrinsics& camera) {
  const std::vector<double> values = node.reals();
  const bool radtan = camera.model == CameraModel::PinholeRadtan;
  if (values.size() != 4 && !(radtan && values.size() == 5))
    throw node.error(fmt::format("has {} coefficients", values.size()),
                     radtan ? "Give k1, k2, p1, p2 and if you like k3" : "Give k1, k2, k3, k4");
  camera.distortion = {};
  std::copy(values.begin(), values.end(), camera.distortion.begin());
}

CameraIntrinsics readOwn(const YamlNode& map) {
  map.allowOnly({"model", "resolution_px", "focal_length_px", "principal_point_px", "distortion"});
  CameraIntrinsics camera;
  camera.model = static_cast<CameraModel>(map["model"].choice({"pinhole_radtan", "pinhole_equidistant"}));
  if (const auto node = map.find("resolution_px")) camera.resolution_px = resolution(*node);
  camera.focal_length_px = pair(map["focal_length_px"]);
  camera.principal_point_px = pair(map["principal_point_px"]);
  setDistortion(map["distortion"], camera);
  return camera;
}

// Keys that Kalibr adds for other purposes (T_cam_imu, rostopic, ...) are left alone.
CameraIntrinsics readKalibr(const YamlNode& map) {
  map["camera_model"].choice({"pinhole"});
  CameraIntrinsics camera;
  const std::size_t distortion = map["distortion_model"].choice({"radtan", "equidistant", "none"});
  camera.model = distortion == 1 ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan;
  const std::vector<double> values = map["intrinsics"].reals(4);
  camera.focal_length_px = {values[0], values[1]};
  camera.principal_point_px = {values[2], values[3]};
  if (distortion != 2) setDistortion(map["distortion_coeffs"], camera);
  if (const auto node = map.find("resolution")) camera.resolution_px = resolution(*node);
  return camera;
}

// sensor_msgs/CameraInfo as camera_calibration_parsers writes it, or as `rostopic echo` prints it.
CameraIntrinsics readCameraInfo(const YamlNode& map) {
  const bool parsers = map.has("camera_matrix");
  CameraIntrinsics camera;
  camera.model = map["distortion_model"].choice({"plumb_bob", "equidistant", "fisheye"}) == 0
                     ? CameraModel::PinholeRadtan
                     : CameraModel::PinholeEquidistant;
  const YamlNode matrix = parsers ? map["camera_matrix"]["data"] : map["K"];
  const std::vector<double> k = matrix.reals(9);
  camera.focal_length_px = {k[0], k[4]};
  camera.principal_point_px = {k[2], k[5]};
  setDistortion(parsers ? map["distortion_coefficients"]["data"] : map["D"], camera);
  const char* prefix = parsers ? "image_" : "";
  camera.resolution_px = {map[fmt::format("{}width", prefix)].integer(1, kMostPixels),
                          map[fmt::format("{}height", prefix)].integer(1, kMostPixels)};
  return camera;
}

// eKalibr's: k1 k2 k3 t1 t2, where we and OpenCV have k3 last.
CameraIntrinsics readEkalibr(const YamlNode& map) {
  CameraIntrinsics camera;
  camera.model =
      static_cast<CameraModel>(map["polymorphic_name"].choice({"pinhole_brown_t2", "pinhole_fisheye"}));
  const YamlNode data = map["ptr_wrapper"]["data"];
  camera.resolution_px = {data["img_width"].integer(1, kMostPixels),
                          data["img_height"].integer(1, kMostPixels)};
  camera.focal_length_px = pair(data["focal_length"]);
  camera.principal_point_px = pair(data["principal_point"]);
  if (camera.model == CameraModel::PinholeEquidistant) {
    setDistortion(data["disto_param"], camera);
  } else {
    const std::vector<double> d = data["disto_param"].reals(5);
    camera.distortion = {d[0], d[1], d[3], d[4], d[2]};
  }
  return camera;
}

bool namesStream(const YamlNode& camera, const std::string& stream) {
  const auto topic = camera.isMap() ? camera.find("rostopic") : std::nullopt;
  return topic && topic->isScalar() && topic->text() == stream;
}

// A file's cameras by name: a Kalibr camchain's cam0, cam1, ..., or the cameras of a result.
YamlNode pickCamera(const YamlNode& cameras, const std::string& name, const std::string& stream) {
  const std::vector<std::string> names = cameras.keys();
  for (const std::string& key : names)
    if (key == name) return cameras[key];
  for (const std::string& key : names)
    if (namesStream(cameras[key], stream)) return cameras[key];
  if (names.size() == 1) return cameras[names[0]];
  throw cameras.error(
      fmt::format("has several cameras, none called '{}' or with rostopic '{}'", name, stream),
      fmt::format("There are: {}", joined(names)));
}

bool isCamchain(const YamlNode& root) {
  return root.isMap() && (root.has("cam0") || root.has("cam1")) && !root.has("camera_model");
}

}  // namespace

const char* cameraModelName(CameraModel model) {
  return model == CameraModel::PinholeRadtan ? "pinhole_radtan" : "pinhole_equidistant";
}

CameraIntrinsics readIntrinsics(const YamlNode& map) {
  if (!map.isMap()) throw map.error("must be a map of intrinsics", "Give model, focal_length_px, ...");
  const CameraIntrinsics camera = map.has("polymorphic_name")                ? readEkalibr(map)
                                  : map.has("camera_model")                  ? readKalibr(map)
                                  : map.has("camera_matrix") || map.has("K") ? readCameraInfo(map)
                                                                             : readOwn(map);
  if (camera.resolution_px.known()) {
    validate(camera, map.place());
  } else {
    CameraIntrinsics checked = camera;  // all but the resolution, which the recording will give
    checked.resolution_px = {kMostPixels, kMostPixels};
    validate(checked, map.place());
  }
  return camera;
}

CameraIntrinsics readIntrinsicsFile(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream) {
  const YamlNode root = YamlNode::load(file);
  if (!root.isMap())
    throw root.error("holds no camera intrinsics", "Give intrinsics as Evical, Kalibr or ROS write them");
  if (root.has("evical_result"))
    return readIntrinsics(pickCamera(root["cameras"], camera_name, stream)["intrinsics"]);
  if (isCamchain(root)) return readIntrinsics(pickCamera(root, camera_name, stream));
  if (root.has("Intrinsics")) return readIntrinsics(root["Intrinsics"]);
  if (root.has("intrinsics") && root["intrinsics"].isMap()) return readIntrinsics(root["intrinsics"]);
  return readIntrinsics(root);
}

std::string intrinsicsYaml(const CameraIntrinsics& camera, int indent) {
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  const auto& d = camera.distortion;
  const bool fifth = camera.model == CameraModel::PinholeRadtan && d[4] != 0.0;
  std::string text = fmt::format("{}model: {}\n", blanks, cameraModelName(camera.model));
  if (camera.resolution_px.known())
    text += fmt::format("{}resolution_px: [{}, {}]\n", blanks, camera.resolution_px.width_px,
                        camera.resolution_px.height_px);
  text += fmt::format("{}focal_length_px: [{}, {}]\n", blanks, camera.focal_length_px.x(),
                      camera.focal_length_px.y());
  text += fmt::format("{}principal_point_px: [{}, {}]\n", blanks, camera.principal_point_px.x(),
                      camera.principal_point_px.y());
  text += fmt::format("{}distortion: [{}, {}, {}, {}{}]\n", blanks, d[0], d[1], d[2], d[3],
                      fifth ? fmt::format(", {}", d[4]) : "");
  return text;
}

}  // namespace evical
