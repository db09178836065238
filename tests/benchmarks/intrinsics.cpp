// Intrinsics against the truth of simulated recordings, as a table: `evical_benchmarks intrinsics [--seeds N]
// [--duration S] [--folder DIR] SCENARIO...`. Each recording is simulated into a file and processed as by
// `evical intrinsics`.
#include "core/geometry/camera_model.h"
#include "core/geometry/projection_difference.h"
#include "core/geometry/sphere_lens.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/simulate/simulation.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/benchmarks/scenario_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical::benchmarks::intrinsics {
namespace {

struct Targets {
  double focal_percent = 0.05, principal_px = 0.2, projection_px = 0.1, radius_share = 1.0;
};

Targets targetsOf(const CameraIntrinsics& camera) {
  if (isSphereModel(camera.model)) return {0.05, 0.2, 0.15, 0.95 * shareOfImageCircle(camera)};
  if (camera.model == CameraModel::PinholeEquidistant) return {0.05, 0.2, 0.2, 0.95};
  return {};
}

IntrinsicsVector parametersOf(const CameraIntrinsics& camera) {
  IntrinsicsVector p;
  p << camera.focal_length_px, camera.principal_point_px,
      Eigen::Map<const Eigen::Matrix<double, 5, 1>>(camera.distortion.data());
  return p;
}

struct Outcome {
  bool met = false;
  std::vector<double> normalised;  // of the estimated parameters
};

// Systematic errors, which are the same in all seeds: mean and RMS of each parameter's errors over sigmas.
void printSums(const std::string& file, const std::vector<Outcome>& outcomes) {
  if (outcomes.size() < 2) return;
  std::size_t parameters =
      kIntrinsicsCount;  // some seeds may have selected another model, with other parameters
  for (const Outcome& outcome : outcomes) parameters = std::min(parameters, outcome.normalised.size());
  double all2 = 0.0;
  std::string by_parameter;
  for (std::size_t i = 0; i < parameters; ++i) {
    double sum = 0.0, sum2 = 0.0;
    for (const Outcome& outcome : outcomes) {
      sum += outcome.normalised[i];
      sum2 += std::pow(outcome.normalised[i], 2);
    }
    const auto count = static_cast<double>(outcomes.size());
    by_parameter += fmt::format(" {:+.2f} ({:.2f})", sum / count, std::sqrt(sum2 / count));
    all2 += sum2 / count;
  }
  fmt::print(
      "\nnormalised errors of {}, RMS over {} seeds: {:.2f} (target 0.7-1.4); each parameter's mean "
      "(RMS):{}\n\n",
      file, outcomes.size(), std::sqrt(all2 / static_cast<double>(parameters)), by_parameter);
}

Outcome compare(const Scenario& scenario, const IntrinsicsResult& result) {
  const CameraIntrinsics& truth = scenario.cameras.front().intrinsics;
  const Targets targets = targetsOf(truth);
  const IntrinsicsVector error = parametersOf(result.intrinsics) - parametersOf(truth);
  const IntrinsicsVector sigmas = result.standardDeviations();
  Outcome outcome;
  double normalised2 = 0.0;
  for (int i = 0; i < kIntrinsicsCount; ++i) {
    if (sigmas[i] <= 0.0) continue;
    outcome.normalised.push_back(error[i] / sigmas[i]);
    normalised2 += std::pow(outcome.normalised.back(), 2);
  }
  const double focal_percent =
      100.0 * (idealFocalLength_px(result.intrinsics).array() / idealFocalLength_px(truth).array() - 1.0)
                  .abs()
                  .maxCoeff();
  const double principal_px = error.segment<2>(2).norm();
  const ProjectionDifference projection =
      projectionDifference(truth, result.intrinsics, targets.radius_share);
  outcome.met = result.intrinsics.model == truth.model && focal_percent <= targets.focal_percent &&
                principal_px <= targets.principal_px && projection.rms_px <= targets.projection_px;
  const double focal_sigma = 100.0 * sigmas.head<2>().cwiseQuotient(truth.focal_length_px).maxCoeff();
  fmt::print(
      "| {} | {} | {:.4f} ({:.4f}) | {:.3f} ({:.3f}) | {:.3f} ({:.3f}) | {:.3f} | {:.2f} | {} of {} | "
      "{} | {:.1f} | {} |\n",
      scenario.name, scenario.seed, focal_percent, focal_sigma, principal_px, sigmas.segment<2>(2).norm(),
      projection.rms_px, result.image.rms_px, projection.max_px,
      std::sqrt(normalised2 / static_cast<double>(outcome.normalised.size())), result.views_used,
      result.views_found, result.passes, result.elapsed_s, outcome.met ? "met" : "MISSED");
  std::fflush(stdout);
  return outcome;
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Intrinsics of simulated recordings against their truth");
  ScenarioArguments scenarios;
  std::filesystem::path folder = std::filesystem::temp_directory_path() / "evical_intrinsics_accuracy";
  scenarios.addTo(app);
  app.option("--folder", folder, "Folder for the recordings, which are removed at the end");
  if (!app.parse(argc, argv)) return 0;
  fmt::print(
      "| scenario | seed | focal length, % (sigma) | principal point, px (sigma) | projection RMS, px "
      "(sigma) | max, px | normalised error | views | passes | s | targets |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool all_met = true;
  for (const std::string& file : scenarios.files) {
    std::vector<Outcome> outcomes;
    for (int k = 0; k < scenarios.seeds; ++k) {
      const Scenario scenario = scenarios.read(file, k);
      const SimulationSummary made = simulate(scenario, folder, {});
      try {
        outcomes.push_back(compare(scenario, calibrateIntrinsics(readSession(made.session), 0, {}).result));
        all_met = all_met && outcomes.back().met;
      } catch (const CalibrationError& error) {
        fmt::print("| {} | {} | failed: {} |\n", scenario.name, scenario.seed, error.what());
        all_met = false;
      }
      std::filesystem::remove_all(folder);
    }
    printSums(file, outcomes);
  }
  return all_met ? 0 : 1;
}

}  // namespace evical::benchmarks::intrinsics
