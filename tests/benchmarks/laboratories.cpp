// Random laboratories (laboratory_scenarios.h), calibrated with default options, against the truth:
// `evical_benchmarks laboratories [--family NAME]... [--seeds N] [--skip N] [--exact] [--ideal PX]
// [--detections FOLDER]
// [--variant OPTION=VALUE,...]... [--faults N]`. Sessions have the usual errors of board size and lens,
// unless --exact. Fails if a calibration fails, if a wrong result is reported as ok, or if the errors over
// sigmas of 20 laboratories or more leave 0.7 to 1.4. Errors of time offsets are without the pixels' delay,
// which the detected centres show.
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
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::benchmarks::laboratories {
namespace {

struct Arguments {
  std::vector<std::string> families;
  int seeds = 40, skipped = 0, faults = 0;
  double ideal_px = 0.0;
  bool exact = false, quantities = false, agreement = false;
  std::string detections;
  std::vector<std::string> variants;

  void addTo(Command& app) {
    std::vector<std::string> words(kLaboratoryFamilies.begin(), kLaboratoryFamilies.end());
    words.emplace_back("all");
    app.option("--family", families, "Family of laboratories; all: one after the other")
        .repeated()
        .oneOf(words);
    app.option("--seeds", seeds, "Number of laboratories").between(1, 1000);
    app.option("--skip", skipped, "Number of the first one").between(0, 100'000);
    app.option("--faults", faults, "Number of single faults that are drawn for each laboratory")
        .between(0, 100);
    app.option("--ideal", ideal_px, "Error in px of circles that no events are simulated for; 0: events")
        .between(0.0, 10.0);
    app.flag("--exact", exact, "Sessions without errors");
    app.flag("--quantities", quantities, "Also the error and the sigma of every quantity");
    app.flag("--agreement", agreement,
             "Also how errors of circles of one window agree, by speed and distance");
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

// File of the detections that an earlier run has kept; empty if none are to be kept. Its name has everything
// on which they depend.
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
  return kept.has_pass ? std::optional(std::move(kept.run.detections)) : std::nullopt;
}

void keepDetections(const std::filesystem::path& file, const Outcome& outcome,
                    const DetectionResult& detections) {
  if (file.empty() || !outcome.result) return;
  std::filesystem::create_directories(file.parent_path());
  CalibrationRun run;
  run.result = *outcome.result;
  run.detections = detections;
  run.detections.resolutions_px = {detections.lenses.front().given->resolution_px};
  std::ofstream(file, std::ios::binary) << runData(run);
}

std::string describe(const Scenario& scenario) {
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  return fmt::format(
      "{}x{}{}, {} {}x{}{}, {:.0f} px/s", camera.resolution_px.width_px, camera.resolution_px.height_px,
      camera.model == CameraModel::PinholeRadtan ? "" : " fisheye", boardTypeName(scenario.board.type),
      scenario.board.rows, scenario.board.cols,
      scenario.board.circles == CircleShade::Bright ? " bright" : "", scenario.motion.image_speed_px_s);
}

// The errors of one variant in all laboratories of a family.
struct Results {
  std::string family, variant;
  std::vector<Outcome> outcomes;
  std::vector<double> rotation_deg, translation_mm;  // where the sigma of the translation is small
  int failed = 0, doubtful = 0, wrong = 0, wrong_windows = 0;

  void add(const Scenario& scenario, Outcome outcome);
  bool print() const;
};

void Results::add(const Scenario& scenario, Outcome outcome) {
  constexpr double kSmall_mm = 2.0;
  const std::string who = fmt::format("| {} | {} | {} |", scenario.name, describe(scenario), variant);
  if (!outcome.comparison) {
    ++failed;
    fmt::print("{} | | | | {} |\n", who, outcome.verdictText());
  } else {
    const CameraError& error = outcome.comparison->cameras.front();
    const double sigma_mm = 1e3 * outcome.uncertainty->translation_std_m.norm();
    if (sigma_mm < kSmall_mm) {
      rotation_deg.push_back(error.rotation_deg);
      translation_mm.push_back(error.translation_mm);
    }
    const NormalisedErrors errors({&outcome, 1});
    const bool is_wrong = isWrongOk(outcome);
    wrong += is_wrong;
    doubtful += outcome.verdict != "ok";
    fmt::print("{} {:.4f} ({:.4f}; {:.2f}) | {:.3f} ({:.3f}; {:.2f}) | {:.4f} ({:.2f}) | {:.1f} | {}{} |\n",
               who, error.rotation_deg, kDegPerRad * outcome.uncertainty->rotation_std_rad.norm(),
               errors.rotation.rms(), error.translation_mm, sigma_mm, errors.translation.rms(),
               error.time_offset_ms, errors.time_offset.rms(), outcome.solve_s, is_wrong ? "WRONG but " : "",
               outcome.verdictText());
  }
  std::fflush(stdout);
  outcome.result.reset();
  outcomes.push_back(std::move(outcome));
}

bool Results::print() const {
  const NormalisedErrors errors(outcomes);
  const std::size_t results = outcomes.size() - static_cast<std::size_t>(failed);
  fmt::print(
      "| {} | {} | {} of {} | {} | {} | {} | {:.4f} deg, {:.3f} mm of {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} "
      "|\n",
      family, variant, results, outcomes.size(), results - static_cast<std::size_t>(doubtful), doubtful,
      wrong, medianOf(rotation_deg), medianOf(translation_mm), rotation_deg.size(), errors.rotation.rms(),
      errors.translation.rms(), errors.time_offset.rms(), errors.all.rms());
  return failed == 0 && wrong == 0 && wrong_windows == 0 && errors.areRight();
}

std::vector<std::string> variantsOf(const Arguments& arguments) {
  std::vector<std::string> variants = {"default"};
  variants.insert(variants.end(), arguments.variants.begin(), arguments.variants.end());
  return variants;
}

std::vector<Results> runFamily(const Arguments& arguments, std::size_t family, LaboratoryFaults& faults) {
  std::vector<Results> results;
  for (const std::string& variant : variantsOf(arguments)) {
    results.emplace_back().family = kLaboratoryFamilies[family];
    results.back().variant = variant;
  }
  ErrorAgreement agreement;
  for (int k = 0; k < arguments.seeds; ++k) {
    const Scenario scenario =
        drawLaboratory(static_cast<LaboratoryFamily>(family), arguments.skipped + k, arguments.exact);
    const std::filesystem::path file = fileOf(scenario, arguments);
    std::optional<DetectionResult> kept = keptDetections(file);
    const DetectionResult detections = kept ? std::move(*kept) : detectionsOf(scenario, arguments.ideal_px);
    const std::vector<CentreError> errors = errorsOf(scenario, detections.cameras.front());
    const ErrorFit fit = fitErrors(errors, [](const CentreError& error) { return error.acceleration_px_s2; });
    if (arguments.agreement) agreement.add(errors, fit);
    for (Results& each : results) {
      const bool is_first = &each == &results.front();
      const auto change = [&](Session& session) {
        if (is_first) return;
        forEachSetting(each.variant, [&](const std::string& name, const std::string& value) {
          setOption(session.options, name, value);
        });
      };
      Outcome outcome = calibrateScenario(scenario, detections, change);
      subtractPixelDelay(fit.delay_s, outcome);
      if (arguments.quantities) printQuantities(outcome);
      if (!std::filesystem::exists(file)) keepDetections(file, outcome, detections);
      if (is_first && !scenario.board.hasCircles())
        each.wrong_windows += wrongWindows(scenario, detections.cameras.front());
      if (is_first && arguments.faults > 0) faults.add(scenario, detections, outcome, arguments.faults);
      each.add(scenario, std::move(outcome));
    }
  }
  if (arguments.agreement) agreement.print();
  return results;
}

bool isAmong(const std::string& family, const std::vector<std::string>& families) {
  const auto is = [&](std::string_view name) { return std::ranges::find(families, name) != families.end(); };
  return is(family) || is("all") || (families.empty() && family == kLaboratoryFamilies.front());
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Calibrations of random rigs against the truth");
  Arguments arguments;
  arguments.addTo(app);
  if (!app.parse(argc, argv)) return 0;
  fmt::print(
      "| laboratory | | options | rotation, deg (sigma; error/sigma) | translation, mm (sigma; error/sigma) "
      "| "
      "time offset, ms (error/sigma) | solve, s | verdict |\n|---|---|---|---|---|---|---|---|\n");
  std::vector<Results> results;
  LaboratoryFaults faults;
  for (std::size_t family = 0; family < kLaboratoryFamilies.size(); ++family) {
    if (!isAmong(std::string(kLaboratoryFamilies[family]), arguments.families)) continue;
    std::vector<Results> of_family = runFamily(arguments, family, faults);
    std::ranges::move(of_family, std::back_inserter(results));
  }
  bool good = arguments.faults == 0 || faults.print();
  fmt::print(
      "\n| family | options | results | ok | doubtful | wrong and ok | median error where the sigma is below "
      "2 mm | "
      "rotation, error/sigma | translation | time offset | all quantities "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Results& each : results) good = each.print() && good;
  return good ? 0 : 1;
}

}  // namespace evical::benchmarks::laboratories
