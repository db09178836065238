// Loss of accuracy without known intrinsics, as a table: `evical_benchmarks unknown_intrinsics [--seeds N]
// [--duration S] [--folder DIR] SCENARIO...`. Each recording is simulated into a file and calibrated three
// times, as by `evical calibrate`: with the true intrinsics; with intrinsics that are found first and then
// fixed; and with intrinsics that are estimated jointly with everything else.
#include "core/geometry/projection_difference.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/report/report_options.h"
#include "core/report/truth_comparison.h"
#include "tests/benchmarks/benchmark_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace evical::benchmarks::unknown_intrinsics {
namespace {

enum Way { kTrue, kFound, kJoint, kWays };
constexpr std::array<const char*, kWays> kWayNames = {"true", "found, fixed", "found, joint"};
constexpr double kTarget = 1.5;  // times the errors with true intrinsics
const std::vector<std::string> kParts = {".rotation.",     ".translation.",     ".time_offset",
                                         ".focal_length.", ".principal_point.", ".distortion."};

// Sums over seeds, by group of the names above.
struct Sums {
  std::map<std::string, double> error2, normalised2;
  std::map<std::string, int> counts;

  void add(const TruthComparison& comparison) {
    for (const QuantityDifference& quantity : comparison.quantities) {
      for (const std::string& part : kParts) {
        if (quantity.name.find(part) == std::string::npos || quantity.sigma <= 0.0) continue;
        error2[part] += quantity.difference * quantity.difference;
        normalised2[part] += quantity.normalised() * quantity.normalised();
        ++counts[part];
      }
    }
  }
  double errorRms(const std::string& part) const { return rms(error2, part); }
  double normalisedRms(const std::string& part) const { return rms(normalised2, part); }

 private:
  double rms(const std::map<std::string, double>& sums, const std::string& part) const {
    const auto count = counts.find(part);
    return count == counts.end() ? 0.0 : std::sqrt(sums.at(part) / count->second);
  }
};

void printRow(const Scenario& scenario, Way way, const CalibrationRun& run,
              const TruthComparison& comparison) {
  const CameraError& error = comparison.cameras.front();
  const CameraUncertainty& sigma = run.result.uncertainty.cameras.front();
  const CameraIntrinsics used = run.result.state.cameras.front().lens.inUse().value();
  fmt::print(
      "| {} | {} | {} | {:.4f} ({:.4f}) | {:.3f} ({:.3f}) | {:.4f} ({:.4f}) | {:.4f} | {:.1f} | {} |\n",
      scenario.name, scenario.seed, kWayNames[way], error.rotation_deg,
      kDegPerRad * sigma.rotation_std_rad.norm(), error.translation_mm, 1e3 * sigma.translation_std_m.norm(),
      error.time_offset_ms, 1e3 * sigma.time_offset_std_s,
      projectionDifference(scenario.cameras.front().intrinsics, used).rms_px, run.result.timing.optimise_s,
      statusName(run.result.status));
  std::fflush(stdout);
}

// The front end's work is the same for both ways without intrinsics, so it is done once.
std::array<CalibrationRun, kWays> calibrateEveryWay(const Session& unknown, const Scenario& scenario) {
  std::array<CalibrationRun, kWays> runs;
  Session given = unknown;
  for (std::size_t k = 0; k < given.cameras.size(); ++k)
    given.cameras[k].intrinsics = scenario.cameras[k].intrinsics;
  runs[kTrue] = calibrate(given, RunContext{});
  runs[kJoint] = calibrate(unknown, RunContext{});
  Session held = unknown;
  held.options.optimisation.edit().camera_intrinsics = CameraIntrinsicsChoice::Fixed;
  runs[kFound] = calibrate(held, runs[kJoint].detections, RunContext{}, runs[kJoint].intrinsics);
  return runs;
}

bool printSums(const std::string& file, int seeds, const std::array<Sums, kWays>& sums) {
  fmt::print("\n{}, RMS over {} recordings: errors, and in brackets errors over sigmas\n\n| intrinsics |",
             file, seeds);
  for (const std::string& part : kParts) fmt::print(" {} |", part);
  fmt::print("\n|---|---|---|---|---|---|---|\n");
  for (std::size_t way = 0; way < kWays; ++way) {
    fmt::print("| {} |", kWayNames[way]);
    for (const std::string& part : kParts)
      fmt::print(" {:.3g} ({:.2f}) |", sums[way].errorRms(part), sums[way].normalisedRms(part));
    fmt::print("\n");
  }
  bool met = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const double times = sums[kJoint].errorRms(kParts[k]) / sums[kTrue].errorRms(kParts[k]);
    met = met && times <= kTarget;
    fmt::print("{} {}: {:.2f} times the error with true intrinsics", k == 0 ? "\n" : ",", kParts[k], times);
  }
  fmt::print(" (target {:.1f}: {})\n\n", kTarget, met ? "met" : "MISSED");
  return met;
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Calibrations with and without intrinsics, against the truth of simulated recordings");
  ScenarioArguments scenarios;
  std::filesystem::path folder = std::filesystem::temp_directory_path() / "evical_unknown_intrinsics";
  scenarios.addTo(app);
  app.option("--folder", folder, "Folder for the recordings, which are removed at the end");
  if (!app.parse(argc, argv)) return 0;
  fmt::print(
      "| scenario | seed | intrinsics | rotation, deg (sigma) | translation, mm (sigma) | time offset, ms "
      "(sigma) | projection error, px RMS | optimise, s | verdict "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  bool all_met = true;
  for (const std::string& file : scenarios.files) {
    std::array<Sums, kWays> sums;
    for (int k = 0; k < scenarios.seeds; ++k) {
      Scenario scenario = scenarios.read(file, k);
      scenario.intrinsics_in_session = false;
      const SimulationSummary made = simulate(scenario, folder, {});
      Session session = readSession(made.session);
      session.options.report.edit().split_half_check = false;
      const NamedResult truth = readResultYaml(made.truth);
      const std::array<CalibrationRun, kWays> runs = calibrateEveryWay(session, scenario);
      std::filesystem::remove_all(folder);
      for (std::size_t way = 0; way < kWays; ++way) {
        const TruthComparison comparison = compareWithTruth(
            namedResult(session, std::make_shared<CalibrationResult>(runs[way].result), "benchmark"), truth);
        sums[way].add(comparison);
        printRow(scenario, static_cast<Way>(way), runs[way], comparison);
      }
    }
    all_met = printSums(file, scenarios.seeds, sums) && all_met;
  }
  return all_met ? 0 : 1;
}

}  // namespace evical::benchmarks::unknown_intrinsics
