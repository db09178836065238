// Random laboratories: rigs, boards, lenses, light, pixels and motions that are drawn for each number,
// calibrated with default options, against the truth: `evical_benchmarks laboratories [--seeds N] [--skip N]
// [--exact] [--ideal PX] [--detections FOLDER] [--variant OPTION=VALUE,...]... [--faults N]`. Sessions have
// the usual errors of board size and lens, unless --exact. Fails if a calibration fails, if a wrong result is
// reported as ok, or if the errors over sigmas of 20 laboratories or more leave 0.7 to 1.4.
#include "core/numerics/angles.h"
#include "core/numerics/robust.h"
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/session/calibration_options.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/benchmarks/centre_truth.h"
#include "tests/benchmarks/laboratory_faults.h"
#include "tests/benchmarks/scenario_run.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace evical::benchmarks::laboratories {
namespace {

// Draws follow each other in braces or in separate statements: the order of function arguments depends on the compiler.
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

Scenario drawLaboratory(int number, bool exact) {
  constexpr std::uint64_t kFirstSeed = 41'000;
  const std::uint64_t seed = kFirstSeed + static_cast<std::uint64_t>(number);
  Dice dice(seed);
  Scenario scenario;
  scenario.name = fmt::format("laboratory{}", number);
  scenario.seed = seed;
  scenario.duration_s = dice.between(12.0, 24.0);
  const Eigen::Vector3d tilted = Eigen::Vector3d{dice.normal(0.05), 1.0, dice.normal(0.05)}.normalized();
  scenario.gravity_in_world_m_s2 = 9.81 * tilted;
  drawBoard(dice, scenario);
  drawCamera(dice, scenario);
  drawImu(dice, scenario);
  drawMotion(dice, scenario);
  drawScene(dice, scenario);
  drawSession(dice, scenario.session_errors);
  if (exact) scenario.session_errors = {};
  return scenario;
}

struct Arguments {
  int seeds = 40, skipped = 0, faults = 0;
  double ideal_px = 0.0;
  bool exact = false, quantities = false, common = false;
  std::string detections;
  std::vector<std::string> variants;

  void addTo(Command& app) {
    app.option("--seeds", seeds, "Number of laboratories").between(1, 1000);
    app.option("--skip", skipped, "Number of the first one").between(0, 100'000);
    app.option("--faults", faults, "Number of single faults that are drawn for each laboratory")
        .between(0, 100);
    app.option("--ideal", ideal_px, "Error in px of circles that no events are simulated for; 0: events")
        .between(0.0, 10.0);
    app.flag("--exact", exact, "Sessions without errors");
    app.flag("--quantities", quantities, "Also the error and the sigma of every quantity");
    app.flag("--common", common, "Also the errors that all circles of a window have in common, by speed");
    app.option("--detections", detections,
               "Folder for detected boards, which later runs with the same detector use again");
    app.option("--variant", variants, "Options of a further run: option=value,...").repeated();
  }
};

// Fingerprint (FNV-1a) of the sources on which detections depend: simulation, front end, and the draws above.
std::uint64_t detectorFingerprint() {
  std::vector<std::filesystem::path> files = {test::sourcePath("tests/benchmarks/laboratories.cpp")};
  for (const char* folder : {"core/frontend", "core/geometry", "core/numerics", "core/synthetic"})
    for (const auto& entry : std::filesystem::directory_iterator(test::sourcePath(folder)))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::uint64_t fingerprint = 14'695'981'039'346'656'037U;
  for (const std::filesystem::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    for (char byte = 0; stream.get(byte);)
      fingerprint = (fingerprint ^ static_cast<unsigned char>(byte)) * 1'099'511'628'211U;
  }
  return fingerprint;
}

// File of the detections that an earlier run has kept; empty if none are to be kept. Its name has everything on which
// they depend.
std::filesystem::path fileOf(const Scenario& scenario, const Arguments& arguments) {
  if (arguments.detections.empty()) return {};
  static const std::uint64_t detector = detectorFingerprint();
  const std::string ideal =
      arguments.ideal_px > 0.0 ? fmt::format("_ideal{}px", arguments.ideal_px) : std::string();
  return std::filesystem::path(arguments.detections) /
         fmt::format("{}{}{}_{:016x}.data", scenario.name, arguments.exact ? "_exact" : "", ideal, detector);
}

DetectionResult detectionsOf(const Scenario& scenario, double ideal_px) {
  constexpr double kWindow_s = 0.02;
  return ideal_px > 0.0 ? test::perfectPass(scenario, ideal_px, kWindow_s) : detectScenario(scenario);
}

std::optional<DetectionResult> keptDetections(const std::filesystem::path& file) {
  if (file.empty() || !std::filesystem::exists(file)) return std::nullopt;
  ReadRunData kept = readRunData(file);
  return kept.has_pass ? std::optional(std::move(kept.run.pass)) : std::nullopt;
}

void keepDetections(const std::filesystem::path& file, const Outcome& outcome,
                    const DetectionResult& detections) {
  if (file.empty() || !outcome.result) return;
  std::filesystem::create_directories(file.parent_path());
  CalibrationRun run;
  run.result = *outcome.result;
  run.pass = detections;
  run.pass.resolutions_px = {detections.lenses.front().given->resolution_px};
  std::ofstream(file, std::ios::binary) << runData(run);
}

std::string describe(const Scenario& scenario) {
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  return fmt::format(
      "{}x{}{}, {}x{}{}, {:.0f} px/s", camera.resolution_px.width_px, camera.resolution_px.height_px,
      camera.model == CameraModel::PinholeRadtan ? "" : " fisheye", scenario.board.rows, scenario.board.cols,
      scenario.board.circles == CircleShade::Bright ? " bright" : "", scenario.motion.image_speed_px_s);
}

// By fifths of the windows' speeds: RMS along and across the motion in px, and their ratio to the stated sigma.
void printCommon(const Scenario& scenario, const BoardObservations& observations) {
  const std::vector<CentreError> errors = errorsOf(scenario, observations);
  const ErrorFit fit = fitErrors(errors, [](const CentreError& error) { return error.acceleration_px_s2; });
  fmt::print("| {} | common error |", scenario.name);
  for (const CommonErrors& fifth : commonErrors(errors, fit))
    fmt::print(" to {:.0f} px/s: {:.4f}, {:.4f} ({:.4f}; {:.1f}) |", fifth.up_to_px_s, fifth.along_px,
               fifth.across_px, fifth.by_centres_px, fifth.ratio());
  fmt::print("\n");
}

// The errors of one variant in all laboratories.
struct Results {
  std::string variant;
  std::vector<Outcome> outcomes;
  std::vector<double> rotation_deg, translation_mm;
  int failed = 0, doubtful = 0, wrong = 0;

  void add(const Scenario& scenario, Outcome outcome);
  bool print() const;
};

void Results::add(const Scenario& scenario, Outcome outcome) {
  const std::string who = fmt::format("| {} | {} | {} |", scenario.name, describe(scenario),
                                      variant.empty() ? "default" : variant);
  if (!outcome.comparison) {
    ++failed;
    fmt::print("{} | | | | {} |\n", who, outcome.verdictText());
  } else {
    const CameraError& error = outcome.comparison->cameras.front();
    rotation_deg.push_back(error.rotation_deg);
    translation_mm.push_back(error.translation_mm);
    const NormalisedErrors errors({&outcome, 1});
    const bool is_wrong = isWrongOk(outcome);
    wrong += is_wrong;
    doubtful += outcome.verdict != "ok";
    fmt::print("{} {:.4f} ({:.4f}; {:.2f}) | {:.3f} ({:.3f}; {:.2f}) | {:.4f} ({:.2f}) | {:.1f} | {}{} |\n",
               who, error.rotation_deg, kDegPerRad * outcome.uncertainty->rotation_std_rad.norm(),
               errors.rotation.rms(), error.translation_mm,
               1e3 * outcome.uncertainty->translation_std_m.norm(), errors.translation.rms(),
               error.time_offset_ms, errors.time_offset.rms(), outcome.solve_s, is_wrong ? "WRONG but " : "",
               outcome.verdictText());
  }
  std::fflush(stdout);
  outcome.result.reset();
  outcomes.push_back(std::move(outcome));
}

bool Results::print() const {
  fmt::print(
      "\n{}: {} laboratories, {} failed, {} doubtful, {} wrong and ok; median error {:.4f} deg, {:.3f} mm\n",
      variant.empty() ? "default" : variant, outcomes.size(), failed, doubtful, wrong, medianOf(rotation_deg),
      medianOf(translation_mm));
  const bool calibrated = NormalisedErrors(outcomes).print();
  return failed == 0 && wrong == 0 && calibrated;
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Calibrations of random rigs against the truth");
  Arguments arguments;
  arguments.addTo(app);
  if (!app.parse(argc, argv)) return 0;
  std::vector<Results> results(1);
  for (const std::string& variant : arguments.variants) results.emplace_back().variant = variant;
  fmt::print(
      "| laboratory | | options | rotation, deg (sigma; error/sigma) | translation, mm (sigma; error/sigma) "
      "| "
      "time offset, ms (error/sigma) | solve, s | verdict |\n|---|---|---|---|---|---|---|---|\n");
  LaboratoryFaults faults;
  for (int k = 0; k < arguments.seeds; ++k) {
    const Scenario scenario = drawLaboratory(arguments.skipped + k, arguments.exact);
    const std::filesystem::path file = fileOf(scenario, arguments);
    std::optional<DetectionResult> kept = keptDetections(file);
    const DetectionResult detections = kept ? std::move(*kept) : detectionsOf(scenario, arguments.ideal_px);
    if (arguments.common) printCommon(scenario, detections.cameras.front());
    for (Results& each : results) {
      const auto change = [&](Session& session) {
        forEachSetting(each.variant, [&](const std::string& name, const std::string& value) {
          setOption(session.options, name, value);
        });
      };
      Outcome outcome = calibrateScenario(scenario, detections, change);
      if (arguments.quantities) printQuantities(outcome);
      if (!std::filesystem::exists(file)) keepDetections(file, outcome, detections);
      if (&each == &results.front() && arguments.faults > 0)
        faults.add(scenario, detections, outcome, arguments.faults);
      each.add(scenario, std::move(outcome));
    }
  }
  bool good = arguments.faults == 0 || faults.print();
  for (const Results& each : results) good = each.print() && good;
  return good ? 0 : 1;
}

}  // namespace evical::benchmarks::laboratories
