#include "core/synthetic/scenario_yaml.h"

#include "core/base/yaml_node.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/synthetic/room_scene.h"
#include "core/synthetic/scenario_boards.h"
#include "core/synthetic/scenario_fields.h"
#include "core/synthetic/visitors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <vector>

namespace evical {
namespace {

constexpr double kNearestLamp_m = 0.05;

// Must be upper triangular and near the identity.
void getMapping(const YamlNode& map, const char* key, Eigen::Matrix3d& value) {
  const auto node = map.find(key);
  if (!node) return;
  const std::vector<YamlNode> rows = node->items();
  if (rows.size() != 3) throw node->error("must be three rows of three numbers");
  for (int r = 0; r < 3; ++r) {
    const std::vector<double> row = rows[static_cast<std::size_t>(r)].reals(3);
    for (int c = 0; c < 3; ++c) value(r, c) = row[static_cast<std::size_t>(c)];
  }
  if (!value.isUpperTriangular()) throw node->error("must be upper triangular (zeros below the diagonal)");
  constexpr double kLargest = 0.5;
  if ((value - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kLargest)
    throw node->error("is too far from the identity",
                      fmt::format("No entry may differ by more than {}", kLargest));
}

void readGloss(const YamlNode& map, GlossModel& gloss) {
  map.allowOnly({"strength", "spread_deg"});
  double spread_deg = gloss.spread_rad / kRadPerDeg;
  get(map, "strength", gloss.strength, 0.0, 100.0, "");
  get(map, "spread_deg", spread_deg, 0.1, 30.0, "deg");
  gloss.spread_rad = spread_deg * kRadPerDeg;
}

void readHandOverBoard(const YamlNode& map, HandOverBoard& hand) {
  map.allowOnly({"every_s", "stay_s", "height_m", "shadow", "shadow_edge_m"});
  get(map, "every_s", hand.every_s, 0.0, 1000.0, "s");
  get(map, "stay_s", hand.stay_s, 0.0, 100.0, "s");
  get(map, "height_m", hand.height_m, 0.0, 1.0, "m");
  get(map, "shadow", hand.shadow, 0.0, 0.99, "");
  get(map, "shadow_edge_m", hand.shadow_edge_m, 1e-4, 0.1, "m");
  if (hand.every_s > 0.0 && hand.stay_s + kHandComesAndGoes_s > hand.every_s)
    throw map.error("the hand would return before it has left",
                    fmt::format("Set every_s to at least stay_s + {} s", kHandComesAndGoes_s));
}

void readPeople(const YamlNode& map, PeopleModel& people) {
  map.allowOnly({"every_s", "speed_m_s", "distance_m"});
  get(map, "every_s", people.every_s, 0.0, 1000.0, "s");
  get(map, "speed_m_s", people.speed_m_s, 0.1, 10.0, "m/s");
  get(map, "distance_m", people.distance_m, 0.0, 100.0, "m");
  constexpr double kMin_s = 0.2;
  if (people.every_s > 0.0 && people.every_s < kMin_s)
    throw map["every_s"].error("is too short an interval", fmt::format("Give 0, or {} s or more", kMin_s));
}

void readScene(const YamlNode& map, SceneModel& scene) {
  map.allowOnly({"bright_reflectance", "dark_reflectance", "margin_m", "clutter_contrast",
                 "clutter_object_share", "clutter_round_share", "clutter_squares_px", "clutter_distance_m",
                 "clutter_detail_px", "lamp_flicker", "lamp_flicker_hz", "blink_hz", "lamp_m", "gloss",
                 "hand", "people"});
  get(map, "bright_reflectance", scene.bright_reflectance, 1e-3, 1.0, "");
  get(map, "dark_reflectance", scene.dark_reflectance, 1e-3, 1.0, "");
  get(map, "margin_m", scene.margin_m, 0.0, 10.0, "m");
  get(map, "clutter_contrast", scene.clutter_contrast, 0.0, 3.0, "");
  get(map, "clutter_object_share", scene.clutter_object_share, 0.0, 1.0, "");
  get(map, "clutter_round_share", scene.clutter_round_share, 0.0, 1.0, "");
  get(map, "clutter_squares_px", scene.clutter_squares_px, 0.0, 200.0, "px");
  get(map, "clutter_distance_m", scene.clutter_distance_m, 0.0, 100.0, "m");
  get(map, "clutter_detail_px", scene.clutter_detail_px, 0.5, 100.0, "px");
  get(map, "lamp_flicker", scene.lamp_flicker, 0.0, 0.9, "");
  get(map, "lamp_flicker_hz", scene.lamp_flicker_hz, 1.0, 1e4, "Hz");
  get(map, "blink_hz", scene.blink_hz, 0.0, 200.0, "Hz");
  get(map, "lamp_m", scene.lamp_m, -100.0, 100.0);
  if (const auto node = map.find("gloss")) readGloss(*node, scene.gloss);
  if (const auto node = map.find("hand")) readHandOverBoard(*node, scene.hand);
  if (const auto node = map.find("people")) readPeople(*node, scene.people);
  if (scene.lamp_m.z() > -2.0 * scene.hand.height_m || scene.lamp_m.z() > -kNearestLamp_m)
    throw map.error("lamp_m is not in front of the board, or too close to the hand",
                    "Set its z to a negative value, at least twice the hand's height_m in size");
  if (scene.people.every_s > 0.0 && scene.people.distance_m > scene.clutter_distance_m)
    throw map.error("people would walk behind the background",
                    "Set clutter_distance_m to at least people.distance_m");
  if (scene.dark_reflectance >= scene.bright_reflectance)
    throw map.error("dark_reflectance must be less than bright_reflectance");
}

void readHand(const YamlNode& map, HandModel& hand) {
  map.allowOnly({"tremor_deg", "tremor_m", "jerks_per_s", "jerk_deg", "stop_every_s", "stop_s", "walking_m"});
  double tremor_deg = hand.tremor_rad / kRadPerDeg, jerk_deg = hand.jerk_rad / kRadPerDeg;
  get(map, "tremor_deg", tremor_deg, 0.0, 10.0, "deg");
  get(map, "tremor_m", hand.tremor_m, 0.0, 0.1, "m");
  get(map, "jerks_per_s", hand.jerks_per_s, 0.0, 10.0, "1/s");
  get(map, "jerk_deg", jerk_deg, 0.0, 30.0, "deg");
  get(map, "stop_every_s", hand.stop_every_s, 0.0, 1000.0, "s");
  get(map, "stop_s", hand.stop_s, 0.0, 100.0, "s");
  get(map, "walking_m", hand.walking_m, 0.0, 0.2, "m");
  hand.tremor_rad = tremor_deg * kRadPerDeg;
  hand.jerk_rad = jerk_deg * kRadPerDeg;
  constexpr double kRamps_s = 0.5;
  if (hand.stop_every_s > 0.0 && hand.stop_s + kRamps_s > hand.stop_every_s)
    throw map.error("stops would overlap", "Set stop_every_s to at least stop_s + 0.5 s");
}

void readMotion(const YamlNode& map, MotionModel& motion) {
  map.allowOnly({"distance_m", "distance_amplitude_m", "angle_amplitude_deg", "target_amplitude_m",
                 "roll_deg", "lowest_frequency_hz", "highest_frequency_hz", "sinusoids", "image_speed_px_s",
                 "turn_deg", "turn_amplitude_deg", "turn_period_s", "tilt_amplitude_deg", "tilt_period_s",
                 "walk_amplitude_m", "walk_period_s", "hand"});
  double roll_deg = motion.roll_rad / kRadPerDeg, turn_deg = motion.turn_rad / kRadPerDeg,
         turn_amplitude_deg = motion.turn_amplitude_rad / kRadPerDeg,
         tilt_amplitude_deg = motion.tilt_amplitude_rad / kRadPerDeg;
  get(map, "distance_m", motion.distance_m, 0.01, 100.0, "m");
  get(map, "distance_amplitude_m", motion.distance_amplitude_m, 0.0, 100.0, "m");
  get(map, "angle_amplitude_deg", motion.angle_amplitude_rad, 0.0, 80.0, kRadPerDeg);
  get(map, "target_amplitude_m", motion.target_amplitude_m, 0.0, 100.0);
  get(map, "roll_deg", roll_deg, -360.0, 360.0, "deg");
  get(map, "lowest_frequency_hz", motion.lowest_frequency_hz, 1e-3, 50.0, "Hz");
  get(map, "highest_frequency_hz", motion.highest_frequency_hz, 1e-3, 50.0, "Hz");
  get(map, "sinusoids", motion.sinusoids, 1, 100);
  get(map, "image_speed_px_s", motion.image_speed_px_s, 0.0, 1e5, "px/s");
  get(map, "turn_deg", turn_deg, -180.0, 180.0, "deg");
  get(map, "turn_amplitude_deg", turn_amplitude_deg, 0.0, 180.0, "deg");
  get(map, "turn_period_s", motion.turn_period_s, 0.01, 1000.0, "s");
  get(map, "tilt_amplitude_deg", tilt_amplitude_deg, 0.0, 180.0, "deg");
  get(map, "tilt_period_s", motion.tilt_period_s, 0.01, 1000.0, "s");
  get(map, "walk_amplitude_m", motion.walk_amplitude_m, 0.0, 100.0);
  get(map, "walk_period_s", motion.walk_period_s, 0.1, 1000.0, "s");
  if (const auto node = map.find("hand")) readHand(*node, motion.hand);
  motion.roll_rad = roll_deg * kRadPerDeg;
  motion.turn_rad = turn_deg * kRadPerDeg;
  motion.turn_amplitude_rad = turn_amplitude_deg * kRadPerDeg;
  motion.tilt_amplitude_rad = tilt_amplitude_deg * kRadPerDeg;
  if (motion.highest_frequency_hz < motion.lowest_frequency_hz)
    throw map.error("highest_frequency_hz must not be less than lowest_frequency_hz");
  // The sum of n sinusoids of variance a^2 / 2n reaches a sqrt(n).
  if (motion.distance_amplitude_m * std::sqrt(motion.sinusoids) >= motion.distance_m)
    throw map.error("the camera would pass through the board",
                    "Set distance_amplitude_m to less than distance_m / sqrt(sinusoids)");
}

void readIntrinsicsOf(const YamlNode& map, CameraIntrinsics& camera) {
  map.allowOnly({"model", "resolution_px", "focal_length_px", "principal_point_px", "distortion"});
  get(map, "model", camera.model, kCameraModelNames);
  if (const auto node = map.find("resolution_px")) {
    const std::vector<YamlNode> sides = node->items();
    if (sides.size() != 2) throw node->error("must be [width, height]");
    camera.resolution_px = {sides[0].integer(8, 65535), sides[1].integer(8, 65535)};
  }
  get(map, "focal_length_px", camera.focal_length_px);
  get(map, "principal_point_px", camera.principal_point_px);
  if (const auto node = map.find("distortion")) {
    const std::vector<double> numbers = node->reals();
    const auto most = static_cast<std::size_t>(coefficientCount(camera.model));
    if (numbers.size() > most) throw node->error(fmt::format("has more than {} numbers", most));
    camera.distortion.fill(0.0);
    std::copy(numbers.begin(), numbers.end(), camera.distortion.begin());
  }
}

void readPixel(const YamlNode& map, EventPixelModel& pixel) {
  map.allowOnly({"threshold_on", "threshold_off", "threshold_mismatch", "refractory_s", "background_rate_hz",
                 "hot_pixels", "hot_pixel_rate_hz", "blur_px", "latency_s", "low_pass_s", "stamp_jitter_s",
                 "low_pass_light_power", "low_pass_polarity", "vignetting", "threshold_noise", "leak_rate_hz",
                 "readout_rate_hz", "longest_wait_s", "reset_s"});
  get(map, "threshold_on", pixel.threshold_on, 0.01, 5.0, "");
  get(map, "threshold_off", pixel.threshold_off, 0.01, 5.0, "");
  get(map, "threshold_mismatch", pixel.threshold_mismatch, 0.0, 0.5, "");
  get(map, "refractory_s", pixel.refractory_s, 0.0, 1.0, "s");
  get(map, "background_rate_hz", pixel.background_rate_hz, 0.0, 1e4, "Hz");
  get(map, "hot_pixels", pixel.hot_pixels, 0, 100000);
  get(map, "hot_pixel_rate_hz", pixel.hot_pixel_rate_hz, 0.0, 1e6, "Hz");
  get(map, "blur_px", pixel.blur_px, 0.05, 20.0, "px");
  get(map, "latency_s", pixel.latency_s, 0.0, 0.1, "s");
  get(map, "low_pass_s", pixel.low_pass_s, 0.0, 0.1, "s");
  get(map, "stamp_jitter_s", pixel.stamp_jitter_s, 0.0, 0.1, "s");
  get(map, "low_pass_light_power", pixel.low_pass_light_power, 0.0, 2.0, "");
  get(map, "low_pass_polarity", pixel.low_pass_polarity, -0.9, 0.9, "");
  get(map, "vignetting", pixel.vignetting, 0.0, 0.9, "");
  get(map, "threshold_noise", pixel.threshold_noise, 0.0, 0.5, "");
  get(map, "leak_rate_hz", pixel.leak_rate_hz, 0.0, 100.0, "Hz");
  get(map, "readout_rate_hz", pixel.readout_rate_hz, 0.0, 1e10, "Hz");
  get(map, "reset_s", pixel.reset_s, 0.0, 1.0, "s");
  get(map, "longest_wait_s", pixel.longest_wait_s, 0.0, 10.0, "s");
}

void readFrames(const YamlNode& map, FrameModel& frames) {
  map.allowOnly({"rate_hz", "exposure_s", "line_delay_us", "noise", "blur_px", "jpeg_quality"});
  get(map, "rate_hz", frames.rate_hz, 0.1, 1000.0, "Hz");
  get(map, "exposure_s", frames.exposure_s, 0.0, 1.0, "s");
  get(map, "line_delay_us", frames.line_delay_us, -1000.0, 1000.0, "us");
  get(map, "noise", frames.noise, 0.0, 255.0, "");
  get(map, "blur_px", frames.blur_px, 0.05, 20.0, "px");
  get(map, "jpeg_quality", frames.jpeg_quality, 0, 100);
}

void readCamera(const YamlNode& map, SimulatedCamera& camera) {
  map.allowOnly({"name", "stream", "time_offset_s", "same_sensor_as", "board", "imu_from_camera",
                 "intrinsics", "pixel", "frames"});
  get(map, "name", camera.name);
  get(map, "stream", camera.stream);
  get(map, "time_offset_s", camera.time_offset_s, -60.0, 60.0, "s");
  get(map, "same_sensor_as", camera.same_sensor_as);
  get(map, "board", camera.board);
  if (const auto node = map.find("imu_from_camera")) readTransform(*node, camera.imu_from_camera);
  if (const auto node = map.find("intrinsics")) readIntrinsicsOf(*node, camera.intrinsics);
  if (const auto node = map.find("pixel")) readPixel(*node, camera.pixel);
  if (const auto node = map.find("frames")) {
    if (!camera.frames) camera.frames.emplace();
    readFrames(*node, *camera.frames);
  }
}

void readImuFaults(const YamlNode& map, ImuFaults& faults) {
  map.allowOnly({"low_pass_hz", "gyroscope_range_rad_s", "accelerometer_range_m_s2", "gyroscope_step_rad_s",
                 "accelerometer_step_m_s2", "g_sensitivity_rad_s_per_m_s2", "gyroscope_wander_rad_s",
                 "accelerometer_wander_m_s2", "wander_time_s", "spikes", "clock_drift_ppm", "clock_step_s",
                 "stamp_jitter_s", "batch", "lost_share", "lost_packets"});
  get(map, "low_pass_hz", faults.low_pass_hz, 0.0, 1e5, "Hz");
  get(map, "gyroscope_range_rad_s", faults.gyroscope_range_rad_s, 0.0, 1e3, "rad/s");
  get(map, "accelerometer_range_m_s2", faults.accelerometer_range_m_s2, 0.0, 1e4, "m/s^2");
  get(map, "gyroscope_step_rad_s", faults.gyroscope_step_rad_s, 0.0, 1.0, "rad/s");
  get(map, "accelerometer_step_m_s2", faults.accelerometer_step_m_s2, 0.0, 10.0, "m/s^2");
  get(map, "g_sensitivity_rad_s_per_m_s2", faults.g_sensitivity_rad_s_per_m_s2, -0.1, 0.1, "rad s/m");
  get(map, "gyroscope_wander_rad_s", faults.gyroscope_wander_rad_s, 0.0, 1.0, "rad/s");
  get(map, "accelerometer_wander_m_s2", faults.accelerometer_wander_m_s2, 0.0, 10.0, "m/s^2");
  get(map, "wander_time_s", faults.wander_time_s, 1e-4, 1000.0, "s");
  get(map, "spikes", faults.spikes, 0, 100000);
  get(map, "clock_drift_ppm", faults.clock_drift_ppm, -1e5, 1e5, "ppm");
  get(map, "clock_step_s", faults.clock_step_s, -60.0, 60.0, "s");
  get(map, "stamp_jitter_s", faults.stamp_jitter_s, 0.0, 0.1, "s");
  get(map, "batch", faults.batch, 1, 1000);
  get(map, "lost_share", faults.lost_share, 0.0, 0.99, "");
  get(map, "lost_packets", faults.lost_packets, 0, 100000);
}

void readImu(const YamlNode& map, SimulatedImu& imu) {
  map.allowOnly({"name", "stream", "rate_hz", "gyroscope_noise_density", "accelerometer_noise_density",
                 "gyroscope_walk_density", "accelerometer_walk_density", "gyroscope_bias_rad_s",
                 "accelerometer_bias_m_s2", "gyroscope_scale_misalignment",
                 "accelerometer_scale_misalignment", "gyroscope_from_accelerometer_deg",
                 "accelerometer_delay_s", "time_offset_s", "reference_from_imu", "faults"});
  get(map, "name", imu.name);
  get(map, "stream", imu.stream);
  get(map, "rate_hz", imu.rate_hz, 1.0, 1e5, "Hz");
  get(map, "gyroscope_noise_density", imu.gyroscope_density, 0.0, 1.0, "rad/s/sqrt(Hz)");
  get(map, "accelerometer_noise_density", imu.accelerometer_density, 0.0, 10.0, "m/s^2/sqrt(Hz)");
  get(map, "gyroscope_walk_density", imu.gyroscope_walk, 0.0, 1.0, "rad/s^2/sqrt(Hz)");
  get(map, "accelerometer_walk_density", imu.accelerometer_walk, 0.0, 10.0, "m/s^3/sqrt(Hz)");
  get(map, "gyroscope_bias_rad_s", imu.gyroscope_bias_rad_s, -10.0, 10.0);
  get(map, "accelerometer_bias_m_s2", imu.accelerometer_bias_m_s2, -50.0, 50.0);
  getMapping(map, "gyroscope_scale_misalignment", imu.gyroscope_scale_misalignment);
  getMapping(map, "accelerometer_scale_misalignment", imu.accelerometer_scale_misalignment);
  Eigen::Vector3d turn_rad = quaternionLog(imu.gyroscope_from_accelerometer);
  get(map, "gyroscope_from_accelerometer_deg", turn_rad, -20.0, 20.0, kRadPerDeg);
  imu.gyroscope_from_accelerometer = quaternionExp(turn_rad);
  get(map, "accelerometer_delay_s", imu.accelerometer_delay_s, -0.1, 0.1, "s");
  get(map, "time_offset_s", imu.time_offset_s, -60.0, 60.0, "s");
  if (const auto node = map.find("reference_from_imu")) readTransform(*node, imu.reference_from_imu);
  if (const auto node = map.find("faults")) readImuFaults(*node, imu.faults);
}

// `one` is a map that changes the first sensor, `all` a list in which each map changes the base's sensor of
// that index or adds one.
template <class Sensor, class Read>
void readSensors(const YamlNode& root, const char* one, const char* all, bool may_be_none,
                 std::vector<Sensor>& sensors, Read read) {
  if (const auto node = root.find(one)) {
    if (sensors.empty()) sensors.resize(1);
    read(*node, sensors.front());
  }
  if (const auto node = root.find(all)) {
    const std::vector<YamlNode> items = node->items();
    if (items.empty() && !may_be_none) throw node->error("must not be empty");
    sensors.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) read(items[i], sensors[i]);
  }
  std::set<std::string> names, streams;
  for (const Sensor& sensor : sensors) {
    if (!names.insert(sensor.name).second)
      throw root.error(fmt::format("two of its {} have the name {}", all, sensor.name));
    if (!streams.insert(sensor.stream).second)
      throw root.error(fmt::format("two of its {} have the stream {}", all, sensor.stream));
  }
}

void readGravity(const YamlNode& root, Eigen::Vector3d& gravity) {
  double norm = gravity.norm();
  get(root, "gravity_m_s2", gravity);
  if (gravity.norm() < 1e-6)
    throw root["gravity_m_s2"].error("must not be zero",
                                     "Give a vector that points down in the board's frame");
  if (root.has("gravity_m_s2")) norm = gravity.norm();
  get(root, "gravity_norm_m_s2", norm, 0.1, 100.0, "m/s^2");
  gravity *= norm / gravity.norm();
}

// The session's parameters of the recording, and their errors.
void readSession(const YamlNode& map, Scenario& scenario) {
  map.allowOnly(
      {"intrinsics", "spacing_error", "focal_length_error", "principal_point_error_px", "imu_noise_factor"});
  SessionErrors& errors = scenario.session_errors;
  get(map, "spacing_error", errors.spacing, -0.5, 1.0, "");
  get(map, "focal_length_error", errors.focal_length, -0.5, 1.0, "");
  get(map, "principal_point_error_px", errors.principal_point_px, -1000.0, 1000.0, "px");
  get(map, "imu_noise_factor", errors.imu_noise_factor, 1e-3, 1e3, "");
  if (const auto node = map.find("intrinsics"))
    scenario.intrinsics_in_session = node->choice({"false", "true"}) == 1;
}

void shareSensors(const std::string& file, std::vector<SimulatedCamera>& cameras) {
  for (SimulatedCamera& camera : cameras) {
    if (camera.same_sensor_as.empty()) continue;
    const auto sensor = std::find_if(cameras.begin(), cameras.end(), [&](const SimulatedCamera& other) {
      return other.name == camera.same_sensor_as && other.same_sensor_as.empty();
    });
    if (sensor == cameras.end())
      throw badInput(fmt::format("{}: same_sensor_as of {}", file, camera.name),
                     fmt::format("'{}' is not a camera with its own sensor", camera.same_sensor_as),
                     "Name one of the other cameras");
    camera.intrinsics = sensor->intrinsics;
    camera.imu_from_camera = sensor->imu_from_camera;
  }
}

// Checks that need a scenario together with its bases.
void validateWhole(const Scenario& scenario, const std::string& file) {
  validateBoards(scenario, file);
  validateRoom(scenario, file);
  for (std::size_t k = 0; k < scenario.cameras.size(); ++k) {
    const SimulatedCamera& camera = scenario.cameras[k];
    validate(camera.intrinsics, fmt::format("{}: intrinsics of {}", file, camera.name));
    if (camera.frames && camera.stream.find('/') != std::string::npos)
      throw badInput(fmt::format("{}: stream of {}", file, camera.name),
                     fmt::format("'{}' is not a valid name for a folder of frames", camera.stream),
                     "Give a name without slashes");
  }
}

Scenario readFrom(const std::filesystem::path& path, int depth) {
  const YamlNode root = YamlNode::load(path);
  root.allowOnly({"base", "description", "seed", "duration_s", "format", "gravity_m_s2", "gravity_norm_m_s2",
                  "board", "further_boards", "scene", "room", "motion", "camera", "cameras", "imu", "imus",
                  "session"});
  Scenario scenario;
  scenario.cameras.resize(1);
  scenario.imus.resize(1);
  readBeginning(root, path, depth, readFrom, scenario);
  get(root, "duration_s", scenario.duration_s, 0.1, 3600.0, "s");
  get(root, "format", scenario.format, {"bag", "text"});
  if (const auto node = root.find("session")) readSession(*node, scenario);
  readGravity(root, scenario.gravity_in_world_m_s2);
  if (const auto node = root.find("board")) readBoard(*node, scenario);
  if (const auto node = root.find("further_boards")) readFurtherBoards(*node, scenario);
  if (const auto node = root.find("scene")) readScene(*node, scenario.scene);
  if (const auto node = root.find("room")) readRoom(*node, scenario.room);
  if (const auto node = root.find("motion")) readMotion(*node, scenario.motion);
  readSensors(root, "camera", "cameras", false, scenario.cameras, readCamera);
  readSensors(root, "imu", "imus", true, scenario.imus, readImu);
  return scenario;
}

}  // namespace

Scenario readScenario(const std::filesystem::path& path) {
  Scenario scenario = readFrom(path, 0);
  shareSensors(path.string(), scenario.cameras);
  validateWhole(scenario, path.string());
  return scenario;
}

}  // namespace evical
