// Accuracy against the truth of simulated recordings, as a table: `evical_accuracy [--seeds N] [--duration S]
// [--quantities] [--within SIGMAS [--or-doubtful] [--board] | --verdicts] [--windows SHARE] SCENARIO...`. Recordings are simulated in memory and go through the
// same front end, initialisation and batch as `evical calibrate`. Fails where a target is missed; with --within, where an
// error of rotation, translation or time offset is larger than so many of its sigmas (and called ok); with --verdicts, where a wrong
// result is called ok, or the errors over sigmas of 20 seeds or more leave 0.7 to 1.4.
#include "core/base/stopwatch.h"
#include "core/frontend/board_tracker.h"
#include "core/numerics/angles.h"
#include "core/pipeline/calibration_pipeline.h"
#include "core/pipeline/camera_views.h"
#include "core/pipeline/result_files.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/frame_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/session_errors.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/support/scenario_session.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evical {
namespace {

struct Targets {
  double windows = 0.85, rotation_deg = 0.1, translation_mm = 2.0, time_offset_ms = 0.2;
};

Targets targetsOf(const std::string& scenario) {
  if (scenario == "davis346" || scenario == "stereo_two_imus") return {0.95, 0.03, 0.7, 0.1};
  if (scenario == "stereo") return {0.95, 0.03, 0.5, 0.1};
  return {};
}

struct Outcome {
  std::string verdict, weakest, reason;
  double windows_found = 0.0;  // of those with enough of the board in view
  double events_per_s = 0.0;
  double detect_s = 0.0, solve_s = 0.0;
  std::optional<TruthComparison> comparison;
  std::optional<CameraUncertainty> uncertainty;
};

// The front end over the events as they are simulated; its own time is measured apart.
BoardObservations fromEvents(const Scenario& scenario, const Session& session, std::size_t k,
                             const CameraIntrinsics& camera, double& busy_s) {
  BoardTracker tracker(session.board, camera.resolution_px, camera, session.options.front_end,
                       scenario.start_ns);
  simulateEvents(scenario, k, [&](EventSpan events) {
    const Stopwatch stopwatch;
    tracker.add(events);
    busy_s += stopwatch.elapsed_s();
  });
  const Stopwatch stopwatch;
  BoardObservations found = tracker.finish();
  busy_s += stopwatch.elapsed_s();
  return found;
}

// The same of frames.
BoardObservations fromFrames(const Scenario& scenario, const Session& session, std::size_t k,
                             const CameraIntrinsics& camera, double& busy_s) {
  const RunContext context;
  const CameraLens lens = givenLens(camera);
  CameraBatch batch;
  batch.camera = k;
  batch.kind = CameraKind::Frames;
  batch.opened_px = camera.resolution_px;
  batch.start_ns = scenario.start_ns;
  const std::unique_ptr<CameraViews> views = cameraViews(batch, {session, lens, context});
  simulateFrames(scenario, k, [&](const Frame& frame) {
    const Stopwatch stopwatch;
    batch.frames = {frame};
    views->take(batch);
    busy_s += stopwatch.elapsed_s();
  });
  const Stopwatch stopwatch;
  std::vector<RecordingFault> faults;
  BoardObservations found = views->finish(faults);
  busy_s += stopwatch.elapsed_s();
  return found;
}

RecordingPass detect(const Scenario& scenario, const Session& session, Outcome& outcome) {
  RecordingPass pass;
  pass.start_ns = scenario.start_ns;
  double busy_s = 0.0;
  std::uint64_t events_read = 0;
  const Scenario said = asSessionSays(scenario);
  for (std::size_t k = 0; k < scenario.cameras.size(); ++k) {
    const CameraIntrinsics& camera = said.cameras[k].intrinsics;
    const auto find = scenario.cameras[k].frames ? fromFrames : fromEvents;
    pass.cameras.push_back(find(scenario, session, k, camera, busy_s));
    pass.lenses.push_back(givenLens(camera));
    pass.cameras.back().camera = scenario.cameras[k].name;
    events_read += pass.cameras.back().events;
  }
  for (std::size_t k = 0; k < scenario.imus.size(); ++k) {
    const SimulatedImu& imu = said.imus[k];
    pass.imus.push_back(
        {imu.name, {imu.gyroscope_density, imu.accelerometer_density}, simulateImu(scenario, k)});
  }
  pass.detect_s = outcome.detect_s = busy_s;
  outcome.events_per_s = static_cast<double>(events_read) / scenario.duration_s;
  return pass;
}

double windowsFound(const Scenario& scenario, const BoardObservations& observations) {
  const SinusoidMotion motion(scenario);
  int seen = 0, found = 0;
  for (const WindowReport& window : observations.windows) {
    if (!boardInView(motion, scenario, 0, window.time_s)) continue;
    ++seen;
    found += window.outcome == WindowOutcome::Complete || window.outcome == WindowOutcome::Partial;
  }
  return seen == 0 ? 0.0 : static_cast<double>(found) / seen;
}

Outcome run(const Scenario& scenario) {
  Outcome outcome;
  const Session session = test::sessionFor(scenario);
  RecordingPass pass = detect(scenario, session, outcome);
  outcome.windows_found = windowsFound(scenario, pass.cameras.front());
  const Stopwatch stopwatch;
  try {
    const CalibrationRun run = calibrate(session, std::move(pass), RunContext{});
    outcome.verdict = statusName(run.result.status);
    outcome.weakest = run.result.uncertainty.weakest;
    outcome.reason = run.result.reason;
    outcome.comparison =
        compareWithTruth(namedResult(session, std::make_shared<CalibrationResult>(run.result), "benchmark"),
                         test::truthOf(scenario));
    for (const CameraUncertainty& camera : run.result.uncertainty.cameras) {
      CameraUncertainty& worst = outcome.uncertainty ? *outcome.uncertainty : outcome.uncertainty.emplace();
      if (camera.translation_std_m.norm() > worst.translation_std_m.norm()) worst = camera;
    }
  } catch (const CalibrationError& error) {
    outcome.verdict = std::string("failed: ") + error.what();
  }
  outcome.solve_s = stopwatch.elapsed_s();
  return outcome;
}

void printHeader() {
  fmt::print(
      "| scenario | seed | Mev/s | windows found | rotation, deg (sigma) | translation, mm (sigma) | time "
      "offset, ms (sigma) | "
      "detect, s | solve, s | verdict | targets |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
}

CameraError worstCamera(const TruthComparison& comparison) {
  CameraError worst;
  for (const CameraError& camera : comparison.cameras) {
    worst.rotation_deg = std::max(worst.rotation_deg, camera.rotation_deg);
    worst.translation_mm = std::max(worst.translation_mm, camera.translation_mm);
    worst.time_offset_ms = std::max(worst.time_offset_ms, std::abs(camera.time_offset_ms));
  }
  return worst;
}

bool printRow(const Scenario& scenario, const Outcome& o) {
  if (!o.comparison) {
    fmt::print("| {} | {} | {:.1f} | {:.1f} % | | | | {:.1f} | {:.1f} | {} | |\n", scenario.name,
               scenario.seed, o.events_per_s * 1e-6, 100.0 * o.windows_found, o.detect_s, o.solve_s,
               o.verdict);
    return false;
  }
  const CameraError error = worstCamera(*o.comparison);
  const Targets t = targetsOf(scenario.name);
  const bool met = o.windows_found >= t.windows && error.rotation_deg <= t.rotation_deg &&
                   error.translation_mm <= t.translation_mm &&
                   std::abs(error.time_offset_ms) <= t.time_offset_ms;
  fmt::print(
      "| {} | {} | {:.1f} | {:.1f} % | {:.4f} ({:.4f}) | {:.3f} ({:.3f}) | {:.4f} ({:.4f}) | {:.1f} | {:.1f} "
      "| {} | {} |\n",
      scenario.name, scenario.seed, o.events_per_s * 1e-6, 100.0 * o.windows_found, error.rotation_deg,
      kDegPerRad * o.uncertainty->rotation_std_rad.norm(), error.translation_mm,
      1e3 * o.uncertainty->translation_std_m.norm(), error.time_offset_ms,
      1e3 * o.uncertainty->time_offset_std_s, o.detect_s, o.solve_s, o.verdict, met ? "met" : "MISSED");
  std::fflush(stdout);
  return met;
}

void printQuantities(const Outcome& outcome) {
  if (!outcome.comparison) return;
  fmt::print("{}weakest: {}\nreason: {}\n", comparisonTable(*outcome.comparison), outcome.weakest,
             outcome.reason);
}

// In sigmas, of what is needed, and of the board's shape if that matters; very large where there is none.
double worstSigmas(const Outcome& outcome, bool with_board) {
  if (!outcome.comparison) return std::numeric_limits<double>::max();
  double worst = 0.0;
  for (const QuantityDifference& quantity : outcome.comparison->quantities) {
    const auto has = [&](const char* part) { return quantity.name.find(part) != std::string::npos; };
    const bool needed = (has(".rotation.") || has(".translation.") || has(".time_offset")) && !has("drift");
    if (needed || (with_board && has("board."))) worst = std::max(worst, std::abs(quantity.normalised()));
  }
  return worst;
}

// Beyond 4 sigmas and what matters, yet called ok.
bool isWrongOk(const Outcome& outcome) {
  if (!outcome.comparison || outcome.verdict != "ok") return false;
  const auto isWrong = [](const QuantityDifference& quantity) {
    constexpr double kSigmas = 4.0, kRotation_deg = 0.1, kTranslation_mm = 3.0, kTimeOffset_ms = 1.0;
    const auto beyond = [&](const char* part, double bound) {
      return quantity.name.find(part) != std::string::npos && std::abs(quantity.difference) > bound;
    };
    return std::abs(quantity.normalised()) > kSigmas &&
           (beyond(".rotation.", kRotation_deg) || beyond(".translation.", kTranslation_mm) ||
            (beyond(".time_offset", kTimeOffset_ms) && quantity.name.find("drift") == std::string::npos));
  };
  const std::vector<QuantityDifference>& all = outcome.comparison->quantities;
  return std::any_of(all.begin(), all.end(), isWrong);
}

// Honest sigmas: errors over sigmas have RMS 1, whatever the seed. False where they are not, of so many seeds
// that chance does not explain it.
bool printNormalised(const std::vector<Outcome>& outcomes) {
  double rotation2 = 0.0, translation2 = 0.0, offset2 = 0.0, all2 = 0.0;
  int rotations = 0, translations = 0, offsets = 0, all = 0;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.comparison) continue;
    for (const QuantityDifference& quantity : outcome.comparison->quantities) {
      if (quantity.sigma <= 0.0) continue;
      const double squared = quantity.normalised() * quantity.normalised();
      all2 += squared;
      ++all;
      const auto add = [&](const char* part, double& sum, int& count) {
        if (quantity.name.find(part) == std::string::npos) return;
        sum += squared;
        ++count;
      };
      add(".rotation.", rotation2, rotations);
      add(".translation.", translation2, translations);
      add(".time_offset", offset2, offsets);
    }
  }
  const auto rms = [](double sum, int count) { return count == 0 ? 1.0 : std::sqrt(sum / count); };
  fmt::print(
      "\nnormalised errors over {} recordings, RMS: rotation {:.2f}, translation {:.2f}, time offset {:.2f}, "
      "all quantities {:.2f} "
      "(target 0.7-1.4)\n",
      outcomes.size(), rms(rotation2, rotations), rms(translation2, translations), rms(offset2, offsets),
      rms(all2, all));
  constexpr std::size_t kEnoughSeeds = 20;
  const auto isHonest = [](double value) { return value >= 0.7 && value <= 1.4; };
  return outcomes.size() < kEnoughSeeds ||
         (isHonest(rms(rotation2, rotations)) && isHonest(rms(translation2, translations)) &&
          isHonest(rms(offset2, offsets)) && isHonest(rms(all2, all)));
}

// Speed, blur and thresholds change when events come, and must not change the time offset that is found.
struct OffsetSpread {
  double smallest_ms = 0.0, largest_ms = 0.0;
  std::string scenarios;

  void add(const Scenario& scenario, const Outcome& outcome) {
    constexpr std::array kVaried = {"slow",     "fast",           "blur_0.4px",
                                    "blur_1px", "threshold_0.15", "threshold_0.5"};
    if (!outcome.comparison || std::find(kVaried.begin(), kVaried.end(), scenario.name) == kVaried.end())
      return;
    for (const QuantityDifference& quantity : outcome.comparison->quantities) {
      if (quantity.name.find(".time_offset") == std::string::npos) continue;
      smallest_ms = scenarios.empty() ? quantity.difference : std::min(smallest_ms, quantity.difference);
      largest_ms = scenarios.empty() ? quantity.difference : std::max(largest_ms, quantity.difference);
    }
    scenarios += (scenarios.empty() ? "" : ", ") + scenario.name;
  }
  void print() const {
    if (scenarios.find(',') == std::string::npos) return;
    fmt::print("\ntime offsets of {} differ by {:.3f} ms (target 0.15)\n", scenarios,
               largest_ms - smallest_ms);
  }
};

struct Arguments {
  ScenarioArguments scenarios;
  bool all_quantities = false, verdicts = false, or_doubtful = false, board = false;
  std::optional<double> within;
  double windows = 0.0;

  void addTo(CLI::App& app) {
    scenarios.addTo(app);
    app.add_flag("--quantities", all_quantities,
                 "Also every quantity's error and sigma, and the weakest direction");
    app.add_option("--within", within, "Fail where an error is beyond so many sigmas, instead of by targets");
    app.add_flag("--or-doubtful", or_doubtful,
                 "With --within: results that are not called ok may be further off");
    app.add_flag("--board", board, "With --within: the board's size and shape too");
    app.add_option("--windows", windows, "Fail where the board is found in a smaller share of what shows it");
    app.add_flag(
        "--verdicts", verdicts,
        "Fail where a wrong result is ok, or sigmas of 20 seeds are not honest, instead of by targets");
  }
  bool isGood(const Outcome& outcome, bool met) const {
    if (isWrongOk(outcome)) fmt::print("WRONG, but called ok\n");
    if (outcome.windows_found < windows) return false;
    if (within) return worstSigmas(outcome, board) <= *within || (or_doubtful && outcome.verdict != "ok");
    return verdicts ? !isWrongOk(outcome) : met;
  }
};

int main(int argc, char** argv) {
  CLI::App app("Accuracy on simulated recordings against their truth");
  Arguments arguments;
  arguments.addTo(app);
  CLI11_PARSE(app, argc, argv);
  printHeader();
  bool all_good = true;
  OffsetSpread spread;
  for (const std::string& file : arguments.scenarios.files) {
    std::vector<Outcome> outcomes;
    for (int k = 0; k < arguments.scenarios.seeds; ++k) {
      const Scenario scenario = arguments.scenarios.read(file, k);
      outcomes.push_back(run(scenario));
      const bool met = printRow(scenario, outcomes.back());
      all_good = arguments.isGood(outcomes.back(), met) && all_good;
      spread.add(scenario, outcomes.back());
      if (arguments.all_quantities) printQuantities(outcomes.back());
    }
    if (arguments.scenarios.seeds > 1)
      all_good = (printNormalised(outcomes) || !arguments.verdicts) && all_good;
  }
  spread.print();
  return all_good ? 0 : 1;
}

}  // namespace
}  // namespace evical

int main(int argc, char** argv) {
  return evical::guarded(evical::main, argc, argv);
}
