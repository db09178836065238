#include "tests/benchmarks/laboratory_scenarios.h"

#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace evical::benchmarks {
namespace {

// Draws follow each other in braces or in separate statements: the order of function arguments depends on the
// compiler.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}

  double between(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  double logBetween(double least, double most) { return std::exp(between(std::log(least), std::log(most))); }
  double normal(double sigma) { return sigma * std::normal_distribution<double>()(random_); }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  Eigen::Vector3d normals(double sigma) { return {normal(sigma), normal(sigma), normal(sigma)}; }
  Eigen::Quaterniond anyRotation() {
    return Eigen::Quaterniond{normal(1.0), normal(1.0), normal(1.0), normal(1.0)}.normalized();
  }
  template <class T, std::size_t N>
  const T& oneOf(const std::array<T, N>& all) {
    return all[std::min(N - 1, static_cast<std::size_t>(between(0.0, static_cast<double>(N))))];
  }

 private:
  std::mt19937_64 random_;
};

struct Sensor {
  Resolution resolution_px;
  double focal_length_px;
  CameraModel model;
  std::array<double, 5> distortion;
};
constexpr std::array<Sensor, 8> kSensors = {{
    {{346, 260}, 262.0, CameraModel::PinholeRadtan, {-0.33, 0.11, 6e-4, -4e-4, 0.0}},
    {{346, 260}, 330.0, CameraModel::PinholeRadtan, {-0.18, 0.05, -3e-4, 5e-4, 0.0}},
    {{240, 180}, 200.0, CameraModel::PinholeRadtan, {-0.30, 0.09, 2e-4, 3e-4, 0.0}},
    {{320, 320}, 300.0, CameraModel::PinholeRadtan, {-0.22, 0.06, 4e-4, 2e-4, 0.0}},
    {{640, 480}, 485.0, CameraModel::PinholeRadtan, {-0.28, 0.09, 4e-4, -3e-4, 0.0}},
    {{1280, 720}, 905.0, CameraModel::PinholeRadtan, {-0.09, 0.05, 3e-4, -2e-4, 0.0}},
    {{640, 480}, 283.5, CameraModel::PinholeEquidistant, {0.012, -0.006, 0.003, -0.001, 0.0}},
    {{346, 260}, 160.0, CameraModel::PinholeEquidistant, {0.010, -0.004, 0.002, -0.001, 0.0}},
}};

void drawBoard(Dice& dice, Scenario& scenario) {
  constexpr std::array<std::array<int, 2>, 7> kSizes = {
      {{11, 4}, {9, 4}, {7, 3}, {7, 5}, {9, 5}, {5, 4}, {13, 4}}};
  const std::array<int, 2>& size = dice.oneOf(kSizes);
  scenario.board.rows = size[0];
  scenario.board.cols = size[1];
  scenario.board.spacing_m = dice.between(0.03, 0.08);
  scenario.board.radius_m = dice.between(0.33, 0.42) * scenario.board.spacing_m;
  scenario.board.circles = dice.chance(0.25) ? CircleShade::Bright : CircleShade::Dark;
}

void drawSquares(Dice& dice, Scenario& scenario) {
  constexpr std::array<std::array<int, 2>, 5> kCheckerboards = {{{6, 9}, {8, 5}, {7, 10}, {5, 6}, {8, 11}}},
                                              kTags = {{{6, 6}, {5, 4}, {4, 6}, {4, 4}, {5, 7}}},
                                              kMarkers = {{{5, 7}, {6, 8}, {7, 5}, {5, 8}, {4, 6}}};
  Board& board = scenario.board;
  board.type = dice.oneOf(std::array{BoardType::Checkerboard, BoardType::AprilGrid, BoardType::Charuco});
  const bool tags = board.type == BoardType::AprilGrid, markers = board.type == BoardType::Charuco;
  const std::array<int, 2>& size = dice.oneOf(tags ? kTags : markers ? kMarkers : kCheckerboards);
  board.rows = size[0];
  board.cols = size[1];
  board.spacing_m = dice.between(0.03, 0.08);
  board.radius_m = 0.0;
  board.circles = CircleShade::Dark;
  if (tags) board.tag_size_m = board.spacing_m / dice.between(1.25, 1.35);
  if (markers) board.tag_size_m = board.spacing_m * dice.between(0.7, 0.8);
  if (tags) board.first_tag = dice.chance(0.3) ? static_cast<int>(dice.between(1.0, 500.0)) : 0;
  TagPrint& print = scenario.tag_print;
  print.border_bits = dice.chance(0.3) ? 1 : 2;
  print.quarter_turns = dice.chance(0.3) ? static_cast<int>(dice.between(0.0, 3.99)) : 0;
  if (tags && dice.chance(0.3)) print.order = TagOrder::RowsDown;
  if (markers) print.markers = dice.oneOf(std::array<const char*, 3>{"4x4", "5x5", "6x6"});
}

void drawPixels(Dice& dice, EventPixelModel& pixel) {
  const bool dim = dice.chance(0.25);
  pixel.threshold_on = dice.between(0.2, 0.5);
  pixel.threshold_off = pixel.threshold_on * dice.between(0.85, 1.15);
  pixel.threshold_mismatch = dice.between(0.02, 0.05);
  pixel.threshold_noise = dice.between(0.0, 0.04);
  pixel.blur_px = dice.between(0.4, 0.9);
  pixel.low_pass_s = dim ? dice.between(5e-4, 1.2e-3) : dice.between(1.5e-4, 4e-4);
  pixel.low_pass_light_power = dice.between(0.0, 1.0);
  pixel.low_pass_polarity = dice.between(0.0, 0.2);
  pixel.vignetting = dice.between(0.0, 0.3);
  pixel.background_rate_hz = dim ? 0.5 : 0.1;
  pixel.leak_rate_hz = dice.between(0.0, 0.2);
  pixel.refractory_s = dice.logBetween(5e-5, 1e-3);
  pixel.stamp_jitter_s = dice.between(0.0, 5e-5);
  if (dice.chance(0.3)) pixel.readout_rate_hz = 1e7;
}

void drawCamera(Dice& dice, Scenario& scenario) {
  const Sensor& sensor = dice.oneOf(kSensors);
  SimulatedCamera& camera = scenario.cameras.emplace_back();
  const double focal_length_px = sensor.focal_length_px * dice.between(0.95, 1.1);
  camera.intrinsics.model = sensor.model;
  camera.intrinsics.resolution_px = sensor.resolution_px;
  camera.intrinsics.focal_length_px = {focal_length_px, focal_length_px * dice.between(0.998, 1.002)};
  camera.intrinsics.principal_point_px = {
      0.5 * sensor.resolution_px.width_px + dice.normal(0.01 * sensor.resolution_px.width_px),
      0.5 * sensor.resolution_px.height_px + dice.normal(0.01 * sensor.resolution_px.width_px)};
  camera.intrinsics.distortion = sensor.distortion;
  camera.imu_from_camera = {dice.anyRotation(), dice.normals(0.03)};
  camera.time_offset_s = dice.between(-0.01, 0.01);
  drawPixels(dice, camera.pixel);
}

void drawImu(Dice& dice, Scenario& scenario) {
  SimulatedImu& imu = scenario.imus.emplace_back();
  imu.rate_hz = dice.oneOf(std::array{200.0, 400.0, 500.0, 1000.0});
  imu.gyroscope_density = dice.logBetween(1e-4, 5e-4);
  imu.accelerometer_density = dice.logBetween(1.5e-3, 8e-3);
  imu.gyroscope_bias_rad_s = dice.normals(0.01);
  imu.accelerometer_bias_m_s2 = dice.normals(0.1);
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index col = row; col < 3; ++col) {
      const double sigma = row == col ? 0.006 : 0.002;
      imu.gyroscope_scale_misalignment(row, col) += dice.normal(sigma);
      imu.accelerometer_scale_misalignment(row, col) += dice.normal(sigma);
    }
  }
}

// The board's long side is along the image's, and the board fills half of the image.
void drawMotion(Dice& dice, Scenario& scenario) {
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  const double margin_m = 2.0 * scenario.board.spacing_m;
  const Eigen::Vector2d board_m = scenario.board.extent_m() + Eigen::Vector2d::Constant(margin_m);
  const auto [least, most] = std::minmax(board_m.x(), board_m.y());
  const auto [low, wide] = std::minmax(camera.resolution_px.width_px, camera.resolution_px.height_px);
  const double fill = dice.between(0.55, 0.75);
  MotionModel& motion = scenario.motion;
  motion.distance_m = camera.focal_length_px.x() / fill * std::max(least / low, most / wide);
  motion.distance_amplitude_m = dice.between(0.08, 0.14) * motion.distance_m;
  const double z_deg = dice.between(12.0, 24.0), y_deg = dice.between(14.0, 24.0),
               x_deg = dice.between(14.0, 24.0);
  motion.angle_amplitude_rad = kRadPerDeg * Eigen::Vector3d(x_deg, y_deg, z_deg);
  motion.target_amplitude_m = 0.12 * Eigen::Vector2d(most, least);
  const bool board_is_high = board_m.y() > board_m.x();
  const bool image_is_wide = camera.resolution_px.width_px > camera.resolution_px.height_px;
  motion.roll_rad = (board_is_high == image_is_wide ? 90.0 : 0.0) * kRadPerDeg;
  const double calm_px_s = 40.0, brisk_px_s = 130.0, usual_px = 262.0;
  motion.lowest_frequency_hz = dice.between(0.3, 0.6);
  motion.highest_frequency_hz = dice.logBetween(1.0, 3.0);
  motion.image_speed_px_s =
      dice.logBetween(calm_px_s, brisk_px_s) * std::sqrt(camera.focal_length_px.x() / usual_px);
  if (dice.chance(0.3)) {
    motion.hand.tremor_rad = dice.between(0.0, 3e-4);
    motion.hand.tremor_m = dice.between(0.0, 1e-4);
  }
}

void drawScene(Dice& dice, Scenario& scenario) {
  SceneModel& scene = scenario.scene;
  scene.margin_m = 1.2 * scenario.board.spacing_m;
  scene.clutter_contrast = dice.chance(0.2) ? 0.0 : dice.between(0.2, 0.6);
  scene.clutter_distance_m = dice.between(0.1, 0.5);
  scene.clutter_detail_px = 2.0 * scenario.cameras.front().intrinsics.resolution_px.width_px / 346.0;
  scene.dark_reflectance = dice.logBetween(0.05, 0.25);
  scene.bright_reflectance = dice.between(0.7, 0.9);
}

// Errors of what people measure by hand and calibrated last month.
void drawSession(Dice& dice, SessionErrors& errors) {
  errors.spacing = dice.normal(0.002);
  errors.focal_length = dice.normal(0.003);
  errors.principal_point_px = dice.normal(0.7);
}

// Sets the properties that the laboratories of a family have in common, in place of the drawn ones.
void setFamily(LaboratoryFamily family, Dice& dice, Scenario& scenario) {
  MotionModel& motion = scenario.motion;
  EventPixelModel& pixel = scenario.cameras.front().pixel;
  const double per_px = std::sqrt(scenario.cameras.front().intrinsics.focal_length_px.x() / 262.0);
  switch (family) {
    case LaboratoryFamily::Usual:
      break;
    case LaboratoryFamily::Calm:
      motion.angle_amplitude_rad *= 0.5;
      motion.target_amplitude_m *= 0.5;
      motion.distance_amplitude_m *= 0.5;
      motion.highest_frequency_hz = 1.0;
      motion.image_speed_px_s = per_px * dice.between(25.0, 45.0);
      break;
    case LaboratoryFamily::Brisk:
      motion.highest_frequency_hz = dice.between(1.5, 3.0);
      motion.image_speed_px_s = per_px * dice.between(130.0, 200.0);
      break;
    case LaboratoryFamily::Dim:
      pixel.low_pass_s = dice.between(5e-4, 1.2e-3);
      pixel.background_rate_hz = 0.5;
      break;
    case LaboratoryFamily::Memory:
      pixel.refractory_s = 1e-3;
      break;
    case LaboratoryFamily::Clutter:
      scenario.scene.clutter_contrast = dice.between(0.3, 0.6);
      scenario.scene.clutter_object_share = 0.9;
      scenario.scene.clutter_round_share = 0.8;
      break;
    case LaboratoryFamily::Squares:
      motion.roll_rad += kRadPerDeg * 90.0 * std::floor(dice.between(0.0, 2.0)) * 2.0;
      break;
  }
}

}  // namespace

Scenario drawLaboratory(LaboratoryFamily family, int number, bool exact) {
  constexpr std::uint64_t kFirstSeed = 41'000;
  const std::uint64_t seed = kFirstSeed + static_cast<std::uint64_t>(number);
  Dice dice(seed);
  Scenario scenario;
  scenario.name = fmt::format("{}{}", kLaboratoryFamilies[static_cast<std::size_t>(family)], number);
  scenario.seed = seed;
  scenario.duration_s = dice.between(12.0, 24.0);
  const Eigen::Vector3d tilted = Eigen::Vector3d{dice.normal(0.05), 1.0, dice.normal(0.05)}.normalized();
  scenario.gravity_in_world_m_s2 = 9.81 * tilted;
  drawBoard(dice, scenario);
  if (family == LaboratoryFamily::Squares) drawSquares(dice, scenario);
  drawCamera(dice, scenario);
  drawImu(dice, scenario);
  drawMotion(dice, scenario);
  drawScene(dice, scenario);
  drawSession(dice, scenario.session_errors);
  setFamily(family, dice, scenario);
  scenario.cameras.front().pixel.reset_s = scenario.cameras.front().pixel.refractory_s;
  if (exact) scenario.session_errors = {};
  return scenario;
}

}  // namespace evical::benchmarks
