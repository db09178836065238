#include "core/synthetic/scenario_yaml.h"

#include "core/base/error.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace evical {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// A map of the file: every key that is read is known; finish() refuses the others.
class MapReader {
 public:
  MapReader(const YAML::Node& node, std::string place) : node_(node), place_(std::move(place)) {
    if (node_ && !node_.IsMap()) throw badInput(place_, "must be a map of keys and values");
  }

  template <class Value>
  void get(const char* key, Value& value) {
    known_.insert(key);
    if (!has(key)) return;
    try {
      value = node_[key].as<Value>();
    } catch (const YAML::Exception&) {
      throw badInput(placeOf(key), fmt::format("'{}' is not what is expected here", YAML::Dump(node_[key])));
    }
  }
  void get(const char* key, double& value, double minimum, double maximum) {
    get(key, value);
    if (!(value >= minimum && value <= maximum)) {
      throw badInput(placeOf(key), fmt::format("{} is not in {} .. {}", value, minimum, maximum));
    }
  }
  void get(const char* key, int& value, int minimum, int maximum) {
    get(key, value);
    if (value < minimum || value > maximum) {
      throw badInput(placeOf(key), fmt::format("{} is not in {} .. {}", value, minimum, maximum));
    }
  }
  template <int Rows>
  void get(const char* key, Eigen::Matrix<double, Rows, 1>& value, double factor = 1.0) {
    std::vector<double> numbers(value.data(), value.data() + Rows);
    for (double& number : numbers) number /= factor;
    get(key, numbers);
    if (numbers.size() != Rows) throw badInput(placeOf(key), fmt::format("must be {} numbers", Rows));
    for (int i = 0; i < Rows; ++i) value(i) = numbers[static_cast<std::size_t>(i)] * factor;
  }
  void get(const char* key, Eigen::Matrix3d& value) {
    std::vector<std::vector<double>> rows;
    get(key, rows);
    if (rows.empty()) return;
    if (rows.size() != 3 ||
        std::any_of(rows.begin(), rows.end(), [](const auto& r) { return r.size() != 3; })) {
      throw badInput(placeOf(key), "must be three rows of three numbers");
    }
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        value(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    }
  }
  MapReader map(const char* key) {
    known_.insert(key);
    return {has(key) ? node_[key] : YAML::Node(YAML::NodeType::Map), placeOf(key)};
  }
  YAML::Node node(const char* key) {
    known_.insert(key);
    return has(key) ? node_[key] : YAML::Node();
  }
  std::string placeOf(const std::string& key) const { return place_ + ": " + key; }
  void finish() const {
    if (!node_) return;
    for (const auto& entry : node_) {
      const std::string key = entry.first.as<std::string>();
      if (known_.contains(key)) continue;
      throw badInput(placeOf(key), "unknown key",
                     fmt::format("Known keys are: {}", fmt::join(known_.begin(), known_.end(), ", ")));
    }
  }

 private:
  bool has(const char* key) const { return node_ && node_.IsMap() && node_[key] && !node_[key].IsNull(); }

  YAML::Node node_;
  std::string place_;
  std::set<std::string> known_;
};

void readBoard(MapReader map, CircleBoard& board) {
  std::string type = board.type == BoardType::AsymmetricCircles ? "asymmetric_circles" : "symmetric_circles";
  std::string shade = board.circles == CircleShade::Dark ? "dark" : "bright";
  map.get("type", type);
  map.get("circles", shade);
  map.get("rows", board.rows, 2, 100);
  map.get("cols", board.cols, 2, 100);
  map.get("spacing_m", board.spacing_m, 1e-4, 10.0);
  map.get("radius_m", board.radius_m, 1e-5, 10.0);
  map.finish();
  if (type != "asymmetric_circles" && type != "symmetric_circles") {
    throw badInput(map.placeOf("type"), "must be asymmetric_circles or symmetric_circles");
  }
  if (shade != "dark" && shade != "bright") throw badInput(map.placeOf("circles"), "must be dark or bright");
  board.type = type == "asymmetric_circles" ? BoardType::AsymmetricCircles : BoardType::SymmetricCircles;
  board.circles = shade == "dark" ? CircleShade::Dark : CircleShade::Bright;
  validate(board);
}

void readScene(MapReader map, SceneModel& scene) {
  map.get("bright_reflectance", scene.bright_reflectance, 1e-3, 1.0);
  map.get("dark_reflectance", scene.dark_reflectance, 1e-3, 1.0);
  map.get("margin_m", scene.margin_m, 0.0, 10.0);
  map.get("clutter_contrast", scene.clutter_contrast, 0.0, 3.0);
  map.get("clutter_distance_m", scene.clutter_distance_m, 0.0, 100.0);
  map.get("clutter_object_share", scene.clutter_object_share, 0.0, 1.0);
  map.get("clutter_detail_px", scene.clutter_detail_px, 0.5, 100.0);
  map.finish();
}

void readMotion(MapReader map, MotionModel& motion) {
  double roll_deg = motion.roll_rad / kRadPerDeg;
  map.get("distance_m", motion.distance_m, 0.01, 100.0);
  map.get("distance_amplitude_m", motion.distance_amplitude_m, 0.0, 100.0);
  map.get("angle_amplitude_deg", motion.angle_amplitude_rad, kRadPerDeg);
  map.get("target_amplitude_m", motion.target_amplitude_m);
  map.get("roll_deg", roll_deg, -360.0, 360.0);
  map.get("lowest_frequency_hz", motion.lowest_frequency_hz, 1e-3, 50.0);
  map.get("highest_frequency_hz", motion.highest_frequency_hz, 1e-3, 50.0);
  map.get("sinusoids", motion.sinusoids, 1, 100);
  map.get("image_speed_px_s", motion.image_speed_px_s, 0.0, 1e5);
  map.finish();
  motion.roll_rad = roll_deg * kRadPerDeg;
}

void readTransform(MapReader map, RigidTransform& transform) {
  Eigen::Vector4d rotation = transform.rotation.coeffs();
  map.get("rotation_xyzw", rotation);
  map.get("translation_m", transform.translation_m);
  map.finish();
  if (rotation.norm() < 1e-6) throw badInput(map.placeOf("rotation_xyzw"), "must not be zero");
  transform.rotation.coeffs() = rotation.normalized();
}

void readIntrinsics(MapReader map, CameraIntrinsics& camera) {
  std::string model = camera.model == CameraModel::PinholeRadtan ? "pinhole_radtan" : "pinhole_equidistant";
  Eigen::Vector2d resolution(camera.resolution_px.width_px, camera.resolution_px.height_px);
  std::vector<double> distortion(camera.distortion.begin(), camera.distortion.end());
  map.get("model", model);
  map.get("resolution_px", resolution);
  map.get("focal_length_px", camera.focal_length_px);
  map.get("principal_point_px", camera.principal_point_px);
  map.get("distortion", distortion);
  map.finish();
  if (model != "pinhole_radtan" && model != "pinhole_equidistant") {
    throw badInput(map.placeOf("model"), "must be pinhole_radtan or pinhole_equidistant");
  }
  if (distortion.size() > camera.distortion.size())
    throw badInput(map.placeOf("distortion"), "has too many numbers");
  camera.model = model == "pinhole_radtan" ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant;
  camera.resolution_px = {static_cast<int>(resolution.x()), static_cast<int>(resolution.y())};
  camera.distortion.fill(0.0);
  std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
  validate(camera, map.placeOf("intrinsics"));
}

void readPixel(MapReader map, EventPixelModel& pixel) {
  map.get("threshold_on", pixel.threshold_on, 0.01, 5.0);
  map.get("threshold_off", pixel.threshold_off, 0.01, 5.0);
  map.get("threshold_mismatch", pixel.threshold_mismatch, 0.0, 0.5);
  map.get("refractory_s", pixel.refractory_s, 0.0, 1.0);
  map.get("background_rate_hz", pixel.background_rate_hz, 0.0, 1e4);
  map.get("hot_pixels", pixel.hot_pixels, 0, 100000);
  map.get("hot_pixel_rate_hz", pixel.hot_pixel_rate_hz, 0.0, 1e6);
  map.get("blur_px", pixel.blur_px, 0.05, 20.0);
  map.get("latency_s", pixel.latency_s, 0.0, 0.1);
  map.get("low_pass_s", pixel.low_pass_s, 0.0, 0.1);
  map.get("stamp_jitter_s", pixel.stamp_jitter_s, 0.0, 0.1);
  map.finish();
}

void readCamera(MapReader map, SimulatedCamera& camera) {
  map.get("name", camera.name);
  map.get("stream", camera.stream);
  map.get("time_offset_s", camera.time_offset_s, -60.0, 60.0);
  readTransform(map.map("imu_from_camera"), camera.imu_from_camera);
  readIntrinsics(map.map("intrinsics"), camera.intrinsics);
  readPixel(map.map("pixel"), camera.pixel);
  map.finish();
}

void readImu(MapReader map, SimulatedImu& imu) {
  map.get("name", imu.name);
  map.get("stream", imu.stream);
  map.get("rate_hz", imu.rate_hz, 1.0, 1e5);
  map.get("gyroscope_noise_density", imu.gyroscope_density, 0.0, 1.0);
  map.get("accelerometer_noise_density", imu.accelerometer_density, 0.0, 10.0);
  map.get("gyroscope_walk_density", imu.gyroscope_walk, 0.0, 1.0);
  map.get("accelerometer_walk_density", imu.accelerometer_walk, 0.0, 10.0);
  map.get("gyroscope_bias_rad_s", imu.gyroscope_bias_rad_s);
  map.get("accelerometer_bias_m_s2", imu.accelerometer_bias_m_s2);
  map.get("gyroscope_mapping", imu.gyroscope_mapping);
  map.get("accelerometer_mapping", imu.accelerometer_mapping);
  map.get("time_offset_s", imu.time_offset_s, -60.0, 60.0);
  readTransform(map.map("reference_from_imu"), imu.reference_from_imu);
  map.finish();
}

YAML::Node load(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw badInput(path.string(), "there is no such scenario");
  try {
    return YAML::LoadFile(path.string());
  } catch (const YAML::Exception& error) {
    throw badInput(path.string(), fmt::format("is not valid YAML: {}", error.what()));
  }
}

Scenario readFrom(const std::filesystem::path& path, int depth) {
  const YAML::Node root = load(path);
  MapReader map(root, path.string());
  Scenario scenario;
  scenario.cameras.resize(1);
  scenario.imus.resize(1);
  std::string base, format;
  map.get("base", base);
  if (!base.empty()) {
    constexpr int kDeepest = 8;
    if (depth > kDeepest)
      throw badInput(map.placeOf("base"), "scenarios that are based on each other without an end");
    scenario = readFrom(path.parent_path() / base, depth + 1);
  }
  double gravity_norm = scenario.gravity_in_world_m_s2.norm();
  int seed = static_cast<int>(scenario.seed);
  scenario.name = path.stem().string();
  map.get("description", base);
  map.get("seed", seed, 0, 1 << 30);
  scenario.seed = static_cast<std::uint64_t>(seed);
  map.get("duration_s", scenario.duration_s, 0.1, 3600.0);
  map.get("format", format);
  map.get("gravity_m_s2", scenario.gravity_in_world_m_s2);
  map.get("gravity_norm_m_s2", gravity_norm, 0.1, 100.0);
  scenario.gravity_in_world_m_s2 *= gravity_norm / scenario.gravity_in_world_m_s2.norm();
  readBoard(map.map("board"), scenario.board);
  readScene(map.map("scene"), scenario.scene);
  readMotion(map.map("motion"), scenario.motion);
  readCamera(map.map("camera"), scenario.cameras.front());
  readImu(map.map("imu"), scenario.imus.front());
  map.finish();
  if (!format.empty() && format != "bag" && format != "text") {
    throw badInput(map.placeOf("format"), "must be bag or text");
  }
  if (!format.empty()) scenario.format = format == "bag" ? SimulatedFormat::Bag : SimulatedFormat::Text;
  return scenario;
}

std::string list(const auto& numbers) {
  return fmt::format("[{:.17g}]", fmt::join(numbers, ", "));
}

std::string vectorText(const Eigen::VectorXd& v) {
  return list(std::vector<double>(v.data(), v.data() + v.size()));
}

std::string matrixText(const Eigen::Matrix3d& m) {
  return fmt::format("[{}, {}, {}]", vectorText(m.row(0).transpose()), vectorText(m.row(1).transpose()),
                     vectorText(m.row(2).transpose()));
}

std::string intrinsicsText(const CameraIntrinsics& c, const std::string& indent) {
  const bool radtan = c.model == CameraModel::PinholeRadtan;
  std::vector<double> d(c.distortion.begin(),
                        c.distortion.begin() + (radtan && c.distortion[4] != 0.0 ? 5 : 4));
  return fmt::format(
      "{0}model: {1}\n{0}resolution_px: [{2}, {3}]\n{0}focal_length_px: {4}\n{0}principal_point_px: {5}\n"
      "{0}distortion: {6}\n",
      indent, radtan ? "pinhole_radtan" : "pinhole_equidistant", c.resolution_px.width_px,
      c.resolution_px.height_px, vectorText(c.focal_length_px), vectorText(c.principal_point_px), list(d));
}

}  // namespace

Scenario readScenario(const std::filesystem::path& path) {
  return readFrom(path, 0);
}

std::string truthYaml(const Scenario& scenario) {
  std::string text = fmt::format("evical_truth: 1\nscenario: {}\nseed: {}\nreference: {}\ncameras:\n",
                                 scenario.name, scenario.seed, scenario.imus.front().name);
  for (const SimulatedCamera& camera : scenario.cameras) {
    text += fmt::format(
        "  {}:\n    reference_from_camera:\n      rotation_xyzw: {}\n      translation_m: {}\n"
        "    time_offset_s: {:.17g}\n    clock_offset_s: {:.17g}\n    photoreceptor_delay_s: {:.17g}\n    "
        "intrinsics:\n{}",
        camera.name, vectorText(camera.imu_from_camera.rotation.coeffs()),
        vectorText(camera.imu_from_camera.translation_m), camera.time_offset_s - camera.pixel.delay_s(),
        camera.time_offset_s, camera.pixel.delay_s(), intrinsicsText(camera.intrinsics, "      "));
  }
  text += "imus:\n";
  for (const SimulatedImu& imu : scenario.imus) {
    text += fmt::format(
        "  {}:\n    reference_from_imu:\n      rotation_xyzw: {}\n      translation_m: {}\n    "
        "time_offset_s: {:.17g}\n"
        "    gyroscope:\n      bias_rad_s: {}\n      mapping: {}\n"
        "    accelerometer:\n      bias_m_s2: {}\n      mapping: {}\n",
        imu.name, vectorText(imu.reference_from_imu.rotation.coeffs()),
        vectorText(imu.reference_from_imu.translation_m), imu.time_offset_s,
        vectorText(imu.gyroscope_bias_rad_s), matrixText(imu.gyroscope_mapping),
        vectorText(imu.accelerometer_bias_m_s2), matrixText(imu.accelerometer_mapping));
  }
  return text + fmt::format("gravity_m_s2: {}\n", vectorText(scenario.gravity_in_world_m_s2));
}

std::string sessionYaml(const Scenario& scenario, const std::string& recording_file) {
  const CircleBoard& board = scenario.board;
  std::string text = fmt::format(
      "evical_session: 1\nrecording: {}\nboard:\n  type: {}\n  rows: {}\n  cols: {}\n  spacing_m: {}\n  "
      "radius_m: {}\n"
      "  circles: {}\ncameras:\n",
      recording_file, board.type == BoardType::AsymmetricCircles ? "asymmetric_circles" : "symmetric_circles",
      board.rows, board.cols, board.spacing_m, board.radius_m,
      board.circles == CircleShade::Dark ? "dark" : "bright");
  for (const SimulatedCamera& camera : scenario.cameras) {
    text +=
        fmt::format("  {}:\n    stream: {}\n    resolution_px: [{}, {}]\n    intrinsics:\n{}", camera.name,
                    camera.stream, camera.intrinsics.resolution_px.width_px,
                    camera.intrinsics.resolution_px.height_px, intrinsicsText(camera.intrinsics, "      "));
  }
  text += "imus:\n";
  for (const SimulatedImu& imu : scenario.imus) {
    text += fmt::format(
        "  {}:\n    stream: {}\n    accelerometer_noise_density: {:.6g}\n    gyroscope_noise_density: "
        "{:.6g}\n"
        "    acceleration_unit: m/s^2\n    angular_rate_unit: rad/s\n",
        imu.name, imu.stream, imu.accelerometer_density, imu.gyroscope_density);
  }
  return text + fmt::format("reference: {}\n", scenario.imus.front().name);
}

}  // namespace evical
