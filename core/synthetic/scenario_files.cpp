#include "core/base/yaml_node.h"
#include "core/format/intrinsics_yaml.h"
#include "core/format/quantity_yaml.h"
#include "core/synthetic/board_surface.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "core/synthetic/session_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace evical {
namespace {

constexpr int kSensorIndent = 6;
constexpr double kMinDensity = 1e-7;  // a session needs a positive noise density, even for a noiseless IMU

std::string vectorText(const Eigen::VectorXd& v) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < v.size(); ++i) text += fmt::format("{}{}", i == 0 ? "" : ", ", v(i));
  return text + "]";
}

std::string transformText(const char* key, const RigidTransform& transform) {
  return fmt::format("    {}:\n      rotation_xyzw: {}\n      translation_m: {}\n", key,
                     vectorText(transform.rotation.coeffs()), vectorText(transform.translation_m));
}

// If the reference IMU's clock runs fast, a camera's offset grows.
std::string driftTruth(const Scenario& scenario, const SimulatedCamera& camera) {
  const double drift_ppm = scenario.imus.empty() ? 0.0 : scenario.imus.front().faults.clock_drift_ppm;
  if (drift_ppm == 0.0) return {};
  return fmt::format("    clock_drift_ppm: {}\n    time_offset_at_s: {}\n", drift_ppm,
                     0.5 * scenario.duration_s - camera.time_offset_s);
}

std::string lineTruth(const SimulatedCamera& camera) {
  if (!camera.frames || camera.frames->line_delay_us == 0.0) return {};
  return fmt::format("    line_delay_us: {}\n", camera.frames->line_delay_us);
}

std::string cameraTruth(const Scenario& scenario, const SimulatedCamera& camera) {
  return fmt::format("  {}:\n{}", yamlText(camera.name),
                     transformText("reference_from_camera", camera.imu_from_camera)) +
         fmt::format("    time_offset_s: {}\n    clock_offset_s: {}\n    photoreceptor_delay_s: {}\n",
                     camera.time_offset_s - camera.delay_s(), camera.time_offset_s, camera.delay_s()) +
         lineTruth(camera) + driftTruth(scenario, camera) + "    intrinsics:\n" +
         intrinsicsYaml(camera.intrinsics, kSensorIndent);
}

// Relative to the session's board (BoardState), including the curvatures.
std::string sheetTruth(const Scenario& scenario, const std::string& indent) {
  const double longer = scenario.board_stretch, said = 1.0 + scenario.session_errors.spacing;
  const BoardSurface surface(scenario);
  if (longer == 0.0 && said == 1.0 && !surface.isBent()) return {};
  std::string text = fmt::format("{0}scale: {1}\n{0}stretch: {2}\n", indent, (1.0 + 0.5 * longer) / said,
                                 -longer / (1.0 + 0.5 * longer));
  if (!surface.isBent()) return text;
  const Eigen::Matrix2d true_from_said = Eigen::Vector2d(1.0, 1.0 + longer).asDiagonal() * (1.0 / said);
  const Eigen::Matrix2d seen = true_from_said * surface.curvature_1_m() * true_from_said;
  return text + fmt::format("{0}row_curvature_1_m: {1}\n{0}column_curvature_1_m: {2}\n{0}twist_1_m: {3}\n",
                            indent, seen(0, 0), seen(1, 1), seen(0, 1));
}

std::string boardTruth(const Scenario& scenario) {
  if (scenario.further_boards.empty()) {
    const std::string sheet = sheetTruth(scenario, "  ");
    return sheet.empty() ? "" : "board:\n" + sheet;
  }
  const std::string sheet = sheetTruth(scenario, "    ");
  std::string text =
      fmt::format("boards:\n  {}:{}\n{}", SimulatedBoard().name, sheet.empty() ? " {}" : "", sheet);
  for (const SimulatedBoard& further : scenario.further_boards)
    text += fmt::format("  {}:\n{}", yamlText(further.name),
                        transformText("world_from_board", further.world_from_board));
  return text;
}

// Pose, clock and delay relative to another camera.
SimulatedCamera relativeTo(const SimulatedCamera& reference, SimulatedCamera camera) {
  camera.imu_from_camera = inverse(reference.imu_from_camera) * camera.imu_from_camera;
  camera.time_offset_s -= reference.time_offset_s;
  camera.pixel.latency_s -= reference.delay_s();
  if (camera.frames)
    camera.time_offset_s += reference.delay_s();  // frames do not have a delay to subtract it from
  return camera;
}

std::string imuTruth(const Scenario& scenario, std::size_t index) {
  const SimulatedImu& imu = scenario.imus[index];
  const SimulatedBiases biases = meanBiases(scenario, index);
  ImuState truth = imu;
  truth.gyroscope_bias_rad_s = biases.gyroscope_rad_s;
  truth.accelerometer_bias_m_s2 = biases.accelerometer_m_s2;
  YamlSections sections;
  forEachQuantity(kImuQuantities, [&](const auto& row) {
    if (row.info.written == QuantityWriting::Always)
      sections.add(row.info.section, row.info.key, quantityYaml(row.value(truth), exactYaml));
  });
  return fmt::format("  {}:\n{}", yamlText(imu.name), sections.text(4));
}

std::string boardText(const Board& board, bool blinks, const std::string& indent) {
  std::string text = fmt::format("{0}type: {1}\n{0}rows: {2}\n{0}cols: {3}\n{0}spacing_m: {4}\n", indent,
                                 boardTypeName(board.type), board.rows, board.cols, board.spacing_m);
  if (board.hasCircles())
    text += fmt::format("{0}radius_m: {1}\n{0}circles: {2}\n", indent, board.radius_m,
                        board.circles == CircleShade::Dark ? "dark" : "bright");
  if (blinks) text += indent + "blinking: true\n";
  if (board.tag_size_m > 0.0) text += fmt::format("{}tag_size_m: {}\n", indent, board.tag_size_m);
  return text;
}

std::string boardSession(const Scenario& scenario) {
  const bool blinks = scenario.scene.blink_hz > 0.0;
  if (scenario.further_boards.empty()) return "board:\n" + boardText(scenario.board, blinks, "  ");
  std::string text =
      fmt::format("boards:\n  {}:\n", SimulatedBoard().name) + boardText(scenario.board, blinks, "    ");
  for (const SimulatedBoard& further : scenario.further_boards)
    text += fmt::format("  {}:\n", yamlText(further.name)) + boardText(further.board, false, "    ");
  return text;
}

}  // namespace

std::string truthYaml(const Scenario& scenario) {
  const std::string& reference =
      scenario.imus.empty() ? scenario.cameras.front().name : scenario.imus.front().name;
  std::string text = fmt::format("evical_truth: 1\nscenario: {}\nseed: {}\nreference: {}\ncameras:\n",
                                 yamlText(scenario.name), scenario.seed, yamlText(reference));
  for (const SimulatedCamera& camera : scenario.cameras)
    text +=
        cameraTruth(scenario, scenario.imus.empty() ? relativeTo(scenario.cameras.front(), camera) : camera);
  text += boardTruth(scenario);
  if (scenario.imus.empty()) return text;
  text += "imus:\n";
  for (std::size_t i = 0; i < scenario.imus.size(); ++i) text += imuTruth(scenario, i);
  return text + fmt::format("gravity_m_s2: {}\n", vectorText(scenario.gravity_in_world_m_s2));
}

std::string sessionYaml(const Scenario& truth, const std::string& recording_file,
                        const std::string& imu_file) {
  const Scenario scenario = asSessionSays(truth);
  std::string text = fmt::format("evical_session: 1\nrecording: {}\n{}cameras:\n", yamlText(recording_file),
                                 boardSession(scenario));
  for (const SimulatedCamera& camera : scenario.cameras) {
    const Resolution& size = camera.intrinsics.resolution_px;
    text += fmt::format("  {}:\n", yamlText(camera.name));
    if (camera.frames) text += fmt::format("    recording: {}\n", kFramesFolder);
    text += fmt::format("    stream: {}\n    resolution_px: [{}, {}]\n", yamlText(camera.stream),
                        size.width_px, size.height_px);
    if (camera.frames && camera.frames->line_delay_us != 0.0) text += "    shutter: rolling\n";
    if (!scenario.further_boards.empty()) text += fmt::format("    board: {}\n", yamlText(camera.board));
    if (!camera.same_sensor_as.empty())
      text += fmt::format("    same_sensor_as: {}\n", yamlText(camera.same_sensor_as));
    else if (scenario.intrinsics_in_session)
      text += "    intrinsics:\n" + intrinsicsYaml(camera.intrinsics, kSensorIndent);
  }
  if (scenario.imus.empty())
    return text + fmt::format("reference: {}\n", yamlText(scenario.cameras.front().name));
  text += "imus:\n";
  for (const SimulatedImu& imu : scenario.imus) {
    text += fmt::format(
        "  {}:\n{}    stream: {}\n    accelerometer_noise_density: {:.6g}\n    gyroscope_noise_density: "
        "{:.6g}\n"
        "    acceleration_unit: m/s^2\n    angular_rate_unit: rad/s\n",
        yamlText(imu.name), imu_file.empty() ? "" : fmt::format("    recording: {}\n", yamlText(imu_file)),
        yamlText(imu.stream), std::max(imu.accelerometer_density, kMinDensity),
        std::max(imu.gyroscope_density, kMinDensity));
    if (imu.accelerometer_walk > 0.0)
      text += fmt::format("    accelerometer_random_walk: {:.6g}\n", imu.accelerometer_walk);
    if (imu.gyroscope_walk > 0.0)
      text += fmt::format("    gyroscope_random_walk: {:.6g}\n", imu.gyroscope_walk);
  }
  return text + fmt::format("reference: {}\n", yamlText(scenario.imus.front().name));
}

}  // namespace evical
