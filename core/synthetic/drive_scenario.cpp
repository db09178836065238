#include "core/synthetic/drive_scenario.h"

#include "core/format/quantity_yaml.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/synthetic/scenario_fields.h"
#include "core/synthetic/scenario_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace evical {
namespace {

void readDrive(const YamlNode& map, DriveMotion& motion) {
  map.allowOnly({"stops", "attitudes", "tilt_deg", "stop_s", "drive_s", "wobble_deg", "sway_m",
                 "lowest_wobble_hz", "highest_wobble_hz", "lowest_sway_hz", "highest_sway_hz"});
  double tilt_deg = motion.tilt_rad * kDegPerRad;
  get(map, "stops", motion.stops, 0, 100000);
  get(map, "attitudes", motion.attitudes, 1, 1000);
  get(map, "tilt_deg", tilt_deg, 0.0, 180.0, "deg");
  get(map, "stop_s", motion.stop_s, 0.1, 1000.0, "s");
  get(map, "drive_s", motion.drive_s, 2.0, 10000.0, "s");
  get(map, "wobble_deg", motion.wobble_rad, 0.0, 45.0, kRadPerDeg);
  get(map, "sway_m", motion.sway_m, 0.0, 100.0);
  get(map, "lowest_wobble_hz", motion.lowest_wobble_hz, 1e-3, 50.0, "Hz");
  get(map, "highest_wobble_hz", motion.highest_wobble_hz, 1e-3, 50.0, "Hz");
  get(map, "lowest_sway_hz", motion.lowest_sway_hz, 1e-3, 50.0, "Hz");
  get(map, "highest_sway_hz", motion.highest_sway_hz, 1e-3, 50.0, "Hz");
  motion.tilt_rad = tilt_deg * kRadPerDeg;
}

ImuStep readStep(const YamlNode& map, const DriveScenario& scenario) {
  map.allowOnly({"imu", "at_s", "rotation_deg", "translation_m", "time_offset_s", "gyroscope_bias_rad_s",
                 "accelerometer_bias_m_s2", "accelerometer_scale"});
  ImuStep step;
  const std::string name = map["imu"].text();
  const auto found = std::find_if(scenario.imus.begin(), scenario.imus.end(),
                                  [&](const SimulatedImu& imu) { return imu.name == name; });
  if (found == scenario.imus.end()) throw map["imu"].error("is not one of the scenario's IMUs");
  step.imu = static_cast<std::size_t>(found - scenario.imus.begin());
  get(map, "at_s", step.at_s, 0.0, 1e6, "s");
  get(map, "rotation_deg", step.rotation_rad, -180.0, 180.0, kRadPerDeg);
  get(map, "translation_m", step.translation_m, -10.0, 10.0);
  get(map, "time_offset_s", step.time_offset_s, -60.0, 60.0, "s");
  get(map, "gyroscope_bias_rad_s", step.gyroscope_bias_rad_s, -10.0, 10.0);
  get(map, "accelerometer_bias_m_s2", step.accelerometer_bias_m_s2, -50.0, 50.0);
  get(map, "accelerometer_scale", step.accelerometer_scale, -0.5, 0.5);
  return step;
}

void readShake(const YamlNode& map, MountShake& shake) {
  map.allowOnly({"rate_rad_s", "force_m_s2", "correlation_s"});
  get(map, "rate_rad_s", shake.rate_rad_s, 0.0, 10.0, "rad/s");
  get(map, "force_m_s2", shake.force_m_s2, 0.0, 100.0, "m/s^2");
  get(map, "correlation_s", shake.correlation_s, 1e-3, 1000.0, "s");
}

void readDriveImu(const YamlNode& map, SimulatedImu& imu) {
  map.allowOnly({"name", "stream", "rate_hz", "gyroscope_noise_density", "accelerometer_noise_density",
                 "gyroscope_walk_density", "accelerometer_walk_density", "gyroscope_bias_rad_s",
                 "accelerometer_bias_m_s2", "time_offset_s", "reference_from_imu", "lost_packets", "shake"});
  get(map, "name", imu.name);
  get(map, "stream", imu.stream);
  get(map, "rate_hz", imu.rate_hz, 1.0, 1e5, "Hz");
  get(map, "gyroscope_noise_density", imu.gyroscope_density, 0.0, 1.0, "rad/s/sqrt(Hz)");
  get(map, "accelerometer_noise_density", imu.accelerometer_density, 0.0, 10.0, "m/s^2/sqrt(Hz)");
  get(map, "gyroscope_walk_density", imu.gyroscope_walk, 0.0, 1.0, "rad/s^2/sqrt(Hz)");
  get(map, "accelerometer_walk_density", imu.accelerometer_walk, 0.0, 10.0, "m/s^3/sqrt(Hz)");
  get(map, "gyroscope_bias_rad_s", imu.gyroscope_bias_rad_s, -10.0, 10.0);
  get(map, "accelerometer_bias_m_s2", imu.accelerometer_bias_m_s2, -50.0, 50.0);
  get(map, "time_offset_s", imu.time_offset_s, -60.0, 60.0, "s");
  if (const auto node = map.find("shake")) readShake(*node, imu.shake);
  get(map, "lost_packets", imu.faults.lost_packets, 0, 100000);
  if (const auto node = map.find("reference_from_imu")) readTransform(*node, imu.reference_from_imu);
}

void readImus(const YamlNode& node, DriveScenario& scenario) {
  const std::vector<YamlNode> items = node.items();
  if (items.empty()) throw node.error("must not be empty");
  scenario.imus.resize(items.size());
  std::set<std::string> names, streams;
  for (std::size_t i = 0; i < items.size(); ++i) {
    readDriveImu(items[i], scenario.imus[i]);
    if (!names.insert(scenario.imus[i].name).second || !streams.insert(scenario.imus[i].stream).second)
      throw items[i].error("has the name or the stream of another IMU");
  }
}

void readTrajectory(const YamlNode& map, DriveScenario& scenario) {
  map.allowOnly({"rate_hz", "noise_m", "noise_deg"});
  double noise_deg = scenario.trajectory_noise_rad * kDegPerRad;
  get(map, "rate_hz", scenario.trajectory_hz, 0.0, 1000.0, "Hz");
  get(map, "noise_m", scenario.trajectory_noise_m, 0.0, 10.0, "m");
  get(map, "noise_deg", noise_deg, 0.0, 90.0, "deg");
  scenario.trajectory_noise_rad = noise_deg * kRadPerDeg;
}

DriveScenario readDriveFrom(const std::filesystem::path& path, int depth) {
  const YamlNode root = YamlNode::load(path);
  root.allowOnly(
      {"base", "description", "seed", "duration_s", "gravity_m_s2", "drive", "imus", "steps", "trajectory"});
  DriveScenario scenario;
  readBeginning(root, path, depth, readDriveFrom, scenario);
  get(root, "duration_s", scenario.duration_s, 0.1, 20000.0, "s");
  get(root, "gravity_m_s2", scenario.gravity_m_s2, 0.1, 100.0, "m/s^2");
  if (const auto node = root.find("drive")) readDrive(*node, scenario.motion);
  if (const auto node = root.find("imus")) readImus(*node, scenario);
  if (const auto node = root.find("trajectory")) readTrajectory(*node, scenario);
  if (const auto node = root.find("steps")) {
    scenario.steps.clear();
    for (const YamlNode& step : node->items()) scenario.steps.push_back(readStep(step, scenario));
  }
  return scenario;
}

std::string stepYaml(const DriveScenario& scenario, const ImuStep& step) {
  const auto list = [](const Eigen::Vector3d& v) { return quantityYaml(v, exactYaml); };
  return fmt::format(
      "  - imu: {}\n    at_s: {}\n    rotation_deg: {}\n    translation_m: {}\n    time_offset_s: {}\n"
      "    gyroscope_bias_rad_s: {}\n    accelerometer_bias_m_s2: {}\n    accelerometer_scale: {}\n",
      yamlText(scenario.imus[step.imu].name), step.at_s,
      list(Eigen::Vector3d(kDegPerRad * step.rotation_rad)), list(step.translation_m), step.time_offset_s,
      list(step.gyroscope_bias_rad_s), list(step.accelerometer_bias_m_s2), list(step.accelerometer_scale));
}

}  // namespace

SimulatedImu DriveScenario::imuAt(std::size_t index, double time_s) const {
  SimulatedImu imu = imus[index];
  for (const ImuStep& step : steps) {
    if (step.imu != index || step.at_s > time_s) continue;
    imu.reference_from_imu.rotation = imu.reference_from_imu.rotation * quaternionExp(step.rotation_rad);
    imu.reference_from_imu.translation_m += step.translation_m;
    imu.time_offset_s += step.time_offset_s;
    imu.gyroscope_bias_rad_s += step.gyroscope_bias_rad_s;
    imu.accelerometer_bias_m_s2 += step.accelerometer_bias_m_s2;
    imu.accelerometer_scale_misalignment.diagonal() += step.accelerometer_scale;
  }
  return imu;
}

bool isDriveScenario(const std::filesystem::path& path) {
  constexpr int kDeepest = 8;
  std::filesystem::path file = path;
  for (int depth = 0; depth <= kDeepest; ++depth) {
    const YamlNode root = YamlNode::load(file);
    if (!root.isMap()) return false;
    if (root.has("drive")) return true;
    const auto base = root.find("base");
    if (!base) return false;
    file = file.parent_path() / base->text();
  }
  return false;
}

DriveScenario readDriveScenario(const std::filesystem::path& path) {
  DriveScenario scenario = readDriveFrom(path, 0);
  if (scenario.imus.empty()) throw badInput(path.string(), "has no IMUs", "Add a list `imus`");
  return scenario;
}

std::string driveTruthYaml(const DriveScenario& scenario) {
  std::string text =
      fmt::format("evical_truth: 1\nscenario: {}\nseed: {}\nreference: {}\nimus:\n", yamlText(scenario.name),
                  scenario.seed, yamlText(scenario.imus.front().name));
  for (std::size_t i = 0; i < scenario.imus.size(); ++i) {
    const ImuState truth = scenario.imuAt(i, scenario.duration_s);
    YamlSections sections;
    forEachQuantity(kImuQuantities, [&](const auto& row) {
      if (row.info.written == QuantityWriting::Always)
        sections.add(row.info.section, row.info.key, quantityYaml(row.value(truth), exactYaml));
    });
    text += fmt::format("  {}:\n{}", yamlText(scenario.imus[i].name), sections.text(4));
  }
  text += fmt::format("gravity_m_s2: [0, 0, {}]\nsteps:{}\n", -scenario.gravity_m_s2,
                      scenario.steps.empty() ? " []" : "");
  for (const ImuStep& step : scenario.steps) text += stepYaml(scenario, step);
  return text;
}

}  // namespace evical
