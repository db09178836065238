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
#include "tests/benchmarks/laboratory_scenarios.h"
#include "tests/benchmarks/scenario_run.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace evical::benchmarks::laboratories {
namespace {

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
  std::vector<std::filesystem::path> files = {test::sourcePath("tests/benchmarks/laboratory_scenarios.cpp")};
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
