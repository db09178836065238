// Accuracy against the truth of simulated recordings, as a table: `evical_benchmarks accuracy [--seeds N]
// [--duration S] [--quantities] [--within SIGMAS [--or-doubtful] [--board] | --verdicts] [--windows SHARE]
// SCENARIO...`. Recordings are simulated in memory and processed by the same front end, initialisation and
// batch as in `evical calibrate`. Fails if a target is missed; with --within, if an error of rotation,
// translation or time offset exceeds that many of its sigmas (and the result is called ok); with --verdicts,
// if a wrong result is called ok, or the ratio of errors to sigmas over 20 seeds or more is outside 0.7 to
// 1.4.
#include "core/numerics/angles.h"
#include "core/report/truth_comparison.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/benchmarks/scenario_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace evical::benchmarks::accuracy {
namespace {

struct Targets {
  double windows = 0.85, rotation_deg = 0.1, translation_mm = 2.0, time_offset_ms = 0.2;
};

Targets targetsOf(const std::string& scenario) {
  if (scenario == "davis346" || scenario == "stereo_two_imus") return {0.95, 0.03, 0.7, 0.1};
  if (scenario == "stereo") return {0.95, 0.03, 0.5, 0.1};
  return {};
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
               o.verdictText());
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

// Error in sigmas of each required quantity, and of the board's shape if that matters; very large if there is
// no result.
double worstSigmas(const Outcome& outcome, bool with_board) {
  if (!outcome.comparison) return std::numeric_limits<double>::max();
  double worst = 0.0;
  for (const QuantityDifference& quantity : outcome.comparison->quantities) {
    const bool needed = isOf(".rotation.", quantity) || isOf(".translation.", quantity) ||
                        isOf(".time_offset", quantity) || (with_board && isOf("board.", quantity));
    if (needed) worst = std::max(worst, std::abs(quantity.normalised()));
  }
  return worst;
}

// Speed, blur and thresholds change the times of events. They must not change the estimated time offset.
struct OffsetSpread {
  double smallest_ms = 0.0, largest_ms = 0.0;
  std::string scenarios;

  void add(const Scenario& scenario, const Outcome& outcome) {
    constexpr std::array kVaried = {"slow",     "fast",           "blur_0.4px",
                                    "blur_1px", "threshold_0.15", "threshold_0.5"};
    if (!outcome.comparison || std::find(kVaried.begin(), kVaried.end(), scenario.name) == kVaried.end())
      return;
    for (const QuantityDifference& quantity : outcome.comparison->quantities) {
      if (!isOf(".time_offset", quantity)) continue;
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

  void addTo(Command& app) {
    scenarios.addTo(app);
    app.flag("--quantities", all_quantities,
             "Also every quantity's error and sigma, and the weakest direction");
    app.option("--within", within, "Instead of targets: fail if an error exceeds this many sigmas");
    app.flag("--or-doubtful", or_doubtful, "With --within: results that are not called ok may exceed it");
    app.flag("--board", board, "With --within: also for the board's size and shape");
    app.option("--windows", windows,
               "Fail if the board is found in a smaller share of the windows that show it");
    app.flag("--verdicts", verdicts,
             "Instead of targets: fail if a wrong result is ok, or sigmas of 20 seeds are not realistic");
  }
  bool isGood(const Outcome& outcome, bool met) const {
    if (isWrongOk(outcome)) fmt::print("WRONG, but called ok\n");
    if (outcome.windows_found < windows) return false;
    if (within) return worstSigmas(outcome, board) <= *within || (or_doubtful && outcome.verdict != "ok");
    return verdicts ? !isWrongOk(outcome) : met;
  }
};

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Accuracy on simulated recordings against their truth");
  Arguments arguments;
  arguments.addTo(app);
  if (!app.parse(argc, argv)) return 0;
  printHeader();
  bool all_good = true;
  OffsetSpread spread;
  for (const std::string& file : arguments.scenarios.files) {
    std::vector<Outcome> outcomes;
    for (int k = 0; k < arguments.scenarios.seeds; ++k) {
      const Scenario scenario = arguments.scenarios.read(file, k);
      outcomes.push_back(runScenario(scenario));
      const bool met = printRow(scenario, outcomes.back());
      all_good = arguments.isGood(outcomes.back(), met) && all_good;
      spread.add(scenario, outcomes.back());
      if (arguments.all_quantities) printQuantities(outcomes.back());
    }
    if (arguments.scenarios.seeds > 1)
      all_good = (NormalisedErrors(outcomes).print() || !arguments.verdicts) && all_good;
  }
  spread.print();
  return all_good ? 0 : 1;
}

}  // namespace evical::benchmarks::accuracy
