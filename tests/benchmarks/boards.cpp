// Boards of squares before event cameras, as tables: `evical_benchmarks boards [--board TYPE]... [--part
// NAME]...
// [--seeds N] [--skip N] [--seconds S]`. Parts: imu (davis346 with all imperfections of realistic.yaml), lens
// (intrinsics alone, 640x480), hybrid (events 640x480 and frames, one board), time (calibrate against circles
// in the same run), and families: variants of the first one, each with one condition that makes detection
// harder; also by name.
// Circles are in each table for comparison. Fails if a corner was assigned wrongly, or if a wrong result is
// reported as ok.
#include "core/base/time.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/projection_difference.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/board_truth.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/benchmarks/centre_truth.h"
#include "tests/benchmarks/scenario_run.h"
#include "tests/support/test_folders.h"

#include <fmt/format.h>

#include <QTemporaryDir>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::benchmarks::boards {
namespace {

constexpr double kMmPerM = 1e3, kMsPerS = 1e3;

// Boards of about equal area, the circles' included.
Board boardOfType(BoardType type) {
  Board board;
  board.type = type;
  if (board.hasCircles()) return board;
  board.radius_m = 0.0;
  switch (type) {
    case BoardType::AprilGrid:
      board.rows = board.cols = 6;
      board.spacing_m = 0.0715;
      board.tag_size_m = 0.055;
      break;
    case BoardType::Charuco:
      board.rows = 5;
      board.cols = 7;
      board.spacing_m = 0.07;
      board.tag_size_m = 0.052;
      break;
    default:
      board.rows = 6;
      board.cols = 9;
      board.spacing_m = 0.05;
  }
  return board;
}

void show(BoardType type, Scenario& scenario) {
  scenario.board = boardOfType(type);
  if (!scenario.board.hasCircles()) scenario.motion.roll_rad = 0.0;  // these boards are wide
}

// A condition that differs from the standard one.
struct Family {
  std::string_view name;
  std::function<void(Scenario&)> change;
};

double perDistance(Scenario& scenario, double distance_m) {
  const double factor = distance_m / scenario.motion.distance_m;
  scenario.motion.distance_m = distance_m;
  scenario.motion.distance_amplitude_m *= factor;
  return factor;
}

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"imu", [](Scenario&) {}},
      {"dim",
       [](Scenario& s) {
         s.cameras[0].pixel.low_pass_s = 1.2e-3;
         s.cameras[0].pixel.background_rate_hz = 1.0;
       }},
      {"noise",
       [](Scenario& s) {
         s.cameras[0].pixel.background_rate_hz = 5.0;
         s.cameras[0].pixel.threshold_noise = 0.06;
         s.cameras[0].pixel.hot_pixels = 20;
       }},
      {"few_events",
       [](Scenario& s) {
         // About one event per edge, as an old sensor, or one with high thresholds.
         s.cameras[0].pixel.threshold_on = s.cameras[0].pixel.threshold_off = 1.2;
         s.cameras[0].pixel.threshold_mismatch = 0.1;
       }},
      {"low_contrast",
       [](Scenario& s) {
         s.scene.bright_reflectance = 0.5;
         s.scene.dark_reflectance = 0.15;
       }},
      {"half_in_view",
       [](Scenario& s) {
         s.motion.distance_m *= 0.7;
         s.motion.target_amplitude_m = {0.15, 0.12};
       }},
      {"fast",
       [](Scenario& s) {
         // Mostly rotation: faster translation would exceed the accelerometer's range.
         s.motion.image_speed_px_s = 500.0;
         s.motion.target_amplitude_m = {0.02, 0.015};
         s.motion.distance_amplitude_m = 0.02;
       }},
      {"slow", [](Scenario& s) { s.motion.image_speed_px_s = 20.0; }},
      {"fisheye",
       [](Scenario& s) {
         const Scenario wide = readScenario(test::scenarioPath("fisheye"));
         s.cameras[0].intrinsics = wide.cameras[0].intrinsics;
         s.scene.clutter_detail_px = wide.scene.clutter_detail_px;
         const double roll_rad = s.motion.roll_rad;
         s.motion = wide.motion;
         s.motion.roll_rad = roll_rad;
       }},
      {"near",
       [](Scenario& s) {
         // A small board, as on a sheet of paper.
         const double factor = perDistance(s, 0.25);
         s.board.spacing_m *= factor;
         s.board.radius_m *= factor;
         s.board.tag_size_m *= factor;
         s.scene.margin_m *= factor;
         s.motion.target_amplitude_m *= factor;
       }},
      {"far", [](Scenario& s) { perDistance(s, 2.0); }},
      {"edges_behind",
       [](Scenario& s) {
         s.scene.clutter_contrast = 0.6;
         s.scene.clutter_object_share = 0.95;
         s.scene.clutter_round_share = 0.0;
       }},
      {"squares_behind", [](Scenario& s) { s.scene.clutter_squares_px = 18.0; }},
      {"glossy",
       [](Scenario& s) {
         // Reflections of a lamp as bright as the paper, over a large part of the board.
         s.scene.gloss.strength = 1.0;
         s.scene.gloss.spread_rad = 8.0 * kRadPerDeg;
       }},
      {"one_axis",
       [](Scenario& s) {
         s.motion.angle_amplitude_rad = kRadPerDeg * Eigen::Vector3d(0.0, 15.0, 0.0);
         s.motion.target_amplitude_m = {0.1, 0.0};
         s.motion.distance_amplitude_m = 0.0;
       }},
  };
  return all;
}

struct Rms {
  double squares = 0.0;
  int count = 0;
  void add(double value) { squares += value * value, ++count; }
  double value() const { return count == 0 ? NAN : std::sqrt(squares / count); }
};

struct Arguments {
  std::vector<std::string> types, parts;
  int seeds = 5, skipped = 0;
  double seconds = 20.0;
  bool each = false;
};

Scenario scenarioFor(const char* name, const Arguments& arguments, int k) {
  Scenario scenario = readScenario(test::scenarioPath(name));
  scenario.duration_s = arguments.seconds;
  scenario.seed += static_cast<std::uint64_t>(arguments.skipped + k);
  return scenario;
}

bool runFamily(const Family& family, BoardType type, const Arguments& arguments) {
  Rms rotation_deg, translation_mm, time_ms, in_sigmas[3];
  double found = 0.0, least_found = 1.0, detect_s = 0.0;
  int wrong_windows = 0, wrong_ok = 0;
  std::vector<std::string> verdicts;
  for (int k = 0; k < arguments.seeds; ++k) {
    Scenario scenario = scenarioFor("realistic", arguments, k);
    show(type, scenario);
    family.change(scenario);
    DetectionResult detections = detectScenario(scenario);
    detect_s += detections.detect_s;
    const int wrong = wrongWindows(scenario, detections.cameras[0]);
    wrong_windows += wrong;
    const double delay_s = fitErrors(errorsOf(scenario, detections.cameras[0]), [](const CentreError& error) {
                             return error.acceleration_px_s2;
                           }).delay_s;
    Outcome outcome = calibrateScenario(scenario, std::move(detections));
    subtractPixelDelay(delay_s, outcome);
    found += outcome.windows_found;
    least_found = std::min(least_found, outcome.windows_found);
    wrong_ok += isWrongOk(outcome);
    const std::string verdict = outcome.verdictText();
    if (arguments.each || wrong > 0 || isWrongOk(outcome))
      fmt::print(stderr, "{} {} {}: {:.0f} % found, {} wrong windows, {}\n", family.name, boardTypeName(type),
                 scenario.seed, 100.0 * outcome.windows_found, wrong, verdict);
    verdicts.push_back(outcome.verdict);
    if (!outcome.comparison) continue;
    const PartError rotation = rotationError_deg(*outcome.comparison),
                    translation = translationError_mm(*outcome.comparison),
                    time = timeOffsetError_ms(*outcome.comparison);
    rotation_deg.add(rotation.size);
    translation_mm.add(translation.size);
    time_ms.add(time.size);
    for (const QuantityDifference& number : outcome.comparison->quantities) {
      if (number.sigma <= 0.0) continue;
      if (isOf(".rotation.", number)) in_sigmas[0].add(number.normalised());
      if (isOf(".translation.", number)) in_sigmas[1].add(number.normalised());
      if (isOf(".time_offset", number)) in_sigmas[2].add(number.normalised());
    }
  }
  const auto count = [&](const char* verdict) {
    return std::count(verdicts.begin(), verdicts.end(), verdict);
  };
  fmt::print(
      "| {} | {} | {:.0f} ({:.0f}) | {} | {:.4f} | {:.2f} | {:.3f} | {:.2f} {:.2f} {:.2f} | {} ok, {} "
      "doubtful, {} "
      "failed | {} | {:.2f} |\n",
      family.name, boardTypeName(type), 100.0 * found / arguments.seeds, 100.0 * least_found, wrong_windows,
      rotation_deg.value(), translation_mm.value(), time_ms.value(), in_sigmas[0].value(),
      in_sigmas[1].value(), in_sigmas[2].value(), count("ok"), count("doubtful"), count("failed"), wrong_ok,
      detect_s / (arguments.seeds * arguments.seconds));
  std::fflush(stdout);
  return wrong_windows == 0 && wrong_ok == 0;
}

bool runFamilies(const Arguments& arguments, const std::vector<BoardType>& types,
                 const std::function<bool(std::string_view)>& asked) {
  fmt::print(
      "| family | board | windows found, % (least) | wrong windows | rotation, deg | translation, mm | time "
      "offset, ms | over sigmas | verdicts | wrong and ok | detection, s per s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool right = true;
  for (const Family& family : families()) {
    const bool is_variant = &family != &families().front();
    if (!asked(family.name) && !(is_variant && asked("families"))) continue;
    for (const BoardType type : types) right = runFamily(family, type, arguments) && right;
  }
  return right;
}

void runLens(const Arguments& arguments, const std::vector<BoardType>& types) {
  fmt::print(
      "\n| lens, 640x480 | focal length, % | principal point, px | projection, px | over sigmas | s |\n"
      "|---|---|---|---|---|---|\n");
  for (const BoardType type : types) {
    Rms focal, principal, projection, sigmas, seconds;
    int failed = 0;
    for (int k = 0; k < arguments.seeds; ++k) {
      Scenario scenario = scenarioFor("intrinsics_davis346", arguments, k);
      const Scenario large = readScenario(test::scenarioPath("vga"));
      scenario.cameras[0].intrinsics = large.cameras[0].intrinsics;
      scenario.scene.clutter_detail_px = large.scene.clutter_detail_px;
      scenario.motion.image_speed_px_s = large.motion.image_speed_px_s;
      scenario.imus.clear();
      show(type, scenario);
      const QTemporaryDir folder;
      const SimulationSummary made = simulate(scenario, folder.path().toStdString(), {});
      try {
        const IntrinsicsResult found = calibrateIntrinsics(readSession(made.session), 0, {}).result;
        const CameraIntrinsics& truth = scenario.cameras[0].intrinsics;
        for (Eigen::Index i = 0; i < 2; ++i)
          focal.add(100.0 * (found.intrinsics.focal_length_px[i] / truth.focal_length_px[i] - 1.0));
        principal.add((found.intrinsics.principal_point_px - truth.principal_point_px).norm());
        projection.add(projectionDifference(truth, found.intrinsics, 1.0).rms_px);
        const IntrinsicsVector std = found.standardDeviations();
        for (Eigen::Index i = 0; i < 2; ++i) {
          sigmas.add((found.intrinsics.focal_length_px[i] - truth.focal_length_px[i]) / std[i]);
          sigmas.add((found.intrinsics.principal_point_px[i] - truth.principal_point_px[i]) / std[i + 2]);
        }
        seconds.add(found.elapsed_s);
      } catch (const CalibrationError& error) {
        ++failed;
        fmt::print(stderr, "lens {} {}: {}\n", boardTypeName(type), scenario.seed, error.what());
      }
    }
    fmt::print("| {}{} | {:.4f} | {:.3f} | {:.3f} | {:.2f} | {:.1f} |\n", boardTypeName(type),
               failed > 0 ? fmt::format(", {} failed", failed) : "", focal.value(), principal.value(),
               projection.value(), sigmas.value(), seconds.value());
    std::fflush(stdout);
  }
}

void runHybrid(const Arguments& arguments, const std::vector<BoardType>& types) {
  fmt::print(
      "\n| events to frames, one board | rotation, deg | translation, mm | time offset, ms | verdicts |\n"
      "|---|---|---|---|---|\n");
  for (const BoardType type : types) {
    Rms rotation, translation, time;
    int ok = 0;
    for (int k = 0; k < arguments.seeds; ++k) {
      Scenario scenario = scenarioFor("hybrid_stereo", arguments, k);
      show(type, scenario);
      const Outcome outcome = runScenario(scenario);
      ok += outcome.verdict == "ok";
      if (!outcome.result) {
        fmt::print(stderr, "hybrid {} {}: {}\n", boardTypeName(type), scenario.seed, outcome.verdictText());
        continue;
      }
      const CalibrationState &state = outcome.result->state, truth = trueState(scenario);
      const auto between = [](const CalibrationState& of) {
        return inverse(of.cameras[0].reference_from_camera) * of.cameras[1].reference_from_camera;
      };
      const auto later_s = [&](const CalibrationState& of) {
        const double time_s = state.cameras[0].time_offset_at_s;
        return timeOffsetAt_s(of.cameras[1], time_s) - timeOffsetAt_s(of.cameras[0], time_s);
      };
      rotation.add(kDegPerRad * rotationAngleBetween_rad(between(state).rotation, between(truth).rotation));
      translation.add(kMmPerM * (between(state).translation_m - between(truth).translation_m).norm());
      time.add(kMsPerS * (later_s(state) - later_s(truth)));
    }
    fmt::print("| {} | {:.4f} | {:.3f} | {:.4f} | {} of {} ok |\n", boardTypeName(type), rotation.value(),
               translation.value(), time.value(), ok, arguments.seeds);
    std::fflush(stdout);
  }
}

// Whole calibrations of recorded files, against circles before the same camera.
void runTime(const Arguments& arguments, std::vector<BoardType> types) {
  types.insert(types.begin(), BoardType::AsymmetricCircles);
  fmt::print(
      "\n| calibrate, davis346, 30 s | wall time, s | of circles | detection, us per event "
      "|\n|---|---|---|---|\n");
  double circles_s = 0.0;
  for (const BoardType type : types) {
    Scenario scenario = scenarioFor("davis346", arguments, 0);
    scenario.duration_s = 30.0;
    show(type, scenario);
    const QTemporaryDir folder;
    const Session session = readSession(simulate(scenario, folder.path().toStdString(), {}).session);
    double best_s = INFINITY, us_per_event = 0.0;
    for (int k = 0; k < 3; ++k) {
      const Stopwatch stopwatch;
      const CalibrationRun run = calibrate(session, RunContext{});
      best_s = std::min(best_s, stopwatch.elapsed_s());
      us_per_event = 1e6 * run.detections.detect_s / static_cast<double>(run.detections.cameras[0].events);
    }
    if (circles_s == 0.0) circles_s = best_s;
    fmt::print("| {} | {:.2f} | {:.2f} | {:.3f} |\n", boardTypeName(type), best_s, best_s / circles_s,
               us_per_event);
    std::fflush(stdout);
  }
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Boards of squares before event cameras, against the truth of simulated recordings");
  Arguments arguments;
  std::vector<std::string> parts = {"lens", "hybrid", "time", "families"};
  for (const Family& family : families()) parts.emplace_back(family.name);
  app.option("--board", arguments.types, "Type of board; by default those of squares").repeated();
  app.option("--part", arguments.parts, "Part or family; by default all").repeated().oneOf(parts);
  app.option("--seeds", arguments.seeds, "Number of recordings").between(1, 1000);
  app.option("--skip", arguments.skipped, "Number of first seeds to skip").between(0, 1000);
  app.option("--seconds", arguments.seconds, "Duration of recordings").between(3.0, 600.0);
  app.flag("--each", arguments.each, "Also a line for each recording");
  if (!app.parse(argc, argv)) return 0;
  std::vector<BoardType> types;
  for (const BoardType type : {BoardType::AsymmetricCircles, BoardType::SymmetricCircles,
                               BoardType::Checkerboard, BoardType::AprilGrid, BoardType::Charuco}) {
    const bool squares = type >= BoardType::Checkerboard;
    const auto& asked = arguments.types;
    if (asked.empty() ? squares : std::find(asked.begin(), asked.end(), boardTypeName(type)) != asked.end())
      types.push_back(type);
  }
  const auto asked = [&](std::string_view part) {
    return arguments.parts.empty() ||
           std::find(arguments.parts.begin(), arguments.parts.end(), part) != arguments.parts.end();
  };
  const bool right = runFamilies(arguments, types, asked);
  if (asked("lens")) runLens(arguments, types);
  if (asked("hybrid")) runHybrid(arguments, types);
  if (asked("time")) runTime(arguments, types);
  return right ? 0 : 1;
}

}  // namespace evical::benchmarks::boards
