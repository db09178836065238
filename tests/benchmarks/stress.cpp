// Verdicts of calibrations in which one quantity deviates from the session, as a table: `evical_benchmarks
// stress [--only NAME...] [--seeds N] [--duration S] [--perfect] [--notes] SCENARIO...`. The front end runs
// once per recording; perturbations apply to the later stages, unless their row states otherwise
// (tests/support/perturbations.cpp).
#include "tests/benchmarks/benchmark_program.h"
#include "tests/benchmarks/scenario_run.h"
#include "tests/support/perturbations.h"
#include "tests/support/scenario_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace evical::benchmarks::stress {
namespace {

using test::Perturbation;
using test::PerturbedStage;
using test::Recorded;

// Figures of the worst sensor: spread of residuals over the given noise, share of rejected circles, and the
// difference between the recording's halves in sigmas.
struct Misfit {
  double circles = 0.0, gyroscope = 0.0, accelerometer = 0.0, outliers = 0.0, halves_sigmas = 0.0;
};

Misfit misfitOf(const CalibrationResult& result, const std::vector<ImuData>& imus) {
  Misfit misfit;
  for (const CameraFit& fit : result.cameras) {
    misfit.circles = std::max(misfit.circles, fit.normalised_rms);
    const double circles = std::max(1, fit.circles_used + fit.circles_rejected);
    misfit.outliers = std::max(misfit.outliers, fit.circles_rejected / circles);
  }
  for (std::size_t k = 0; k < result.imus.size(); ++k) {
    const ImuFit& fit = result.imus[k];
    const ImuData& imu = imus.at(k);
    const double root_rate = std::sqrt(imu.rate_hz());
    misfit.gyroscope =
        std::max(misfit.gyroscope, fit.gyroscope_rms_rad_s / (imu.noise.gyroscope_density * root_rate));
    misfit.accelerometer = std::max(
        misfit.accelerometer, fit.accelerometer_rms_m_s2 / (imu.noise.accelerometer_density * root_rate));
  }
  if (result.split_half_check) misfit.halves_sigmas = result.split_half_check->rms_sigmas;
  return misfit;
}

struct Source {
  bool perfect = false;  // circles of an ideal front end: takes seconds

  DetectionResult detections(const Scenario& scenario, const Session& session) const {
    constexpr double kSigma_px = 0.05, kWindow_s = 0.02;
    return perfect ? test::perfectPass(scenario, kSigma_px, kWindow_s)
                   : test::detectedPass(scenario, session);
  }
};

struct Case {
  Outcome outcome;
  Misfit misfit;
};

Case calibrated(const Recorded& recorded) {
  Case of{calibrateSession(recorded.scenario, recorded.session, recorded.detections), {}};
  if (of.outcome.result) of.misfit = misfitOf(*of.outcome.result, recorded.detections.imus);
  return of;
}

Case perturbed(const Recorded& base, const Perturbation& perturbation, double size, const Source& source) {
  Recorded recorded = base;
  perturbation.apply(recorded, size);
  if (perturbation.stage == PerturbedStage::FrontEnd)
    recorded.detections = source.detections(recorded.scenario, recorded.session);
  return calibrated(recorded);
}

// The quantity that the motion leaves too uncertain, if that is the first reason; else empty.
std::string_view tooUncertain(const Outcome& outcome) {
  const std::string_view reason = test::firstReason(outcome.reason);
  const std::size_t at = reason.find(" has a sigma of ");
  return at == std::string_view::npos ? std::string_view() : reason.substr(0, at);
}

// Correct within its sigmas, and doubtful only because this recording moves too little, with or without the
// perturbation.
bool isDoubtfulAsUnspoilt(const Outcome& outcome, const Outcome& unspoilt) {
  return !isWrong(outcome) && outcome.verdict == "doubtful" && !tooUncertain(outcome).empty() &&
         tooUncertain(outcome) == tooUncertain(unspoilt);
}

struct Summary {
  int cases = 0, wrong = 0, wrong_ok = 0;
  int named = 0, nameable = 0;  // results that are not called ok and have a cause
  int as_unspoilt = 0;          // results that are not called ok for another reason than the perturbation
  int ok_unspoilt = 0, unspoilt = 0;

  void add(const Perturbation& perturbation, const Outcome& outcome, const Outcome& twin) {
    ++cases;
    wrong += isWrong(outcome);
    wrong_ok += isWrongOk(outcome);
    if (perturbation.causes.empty()) {
      ++unspoilt;
      ok_unspoilt += outcome.verdict == "ok";
      return;
    }
    if (outcome.verdict == "ok") return;
    if (isDoubtfulAsUnspoilt(outcome, twin)) {
      ++as_unspoilt;
      return;
    }
    ++nameable;
    named += perturbation.isNamedIn(test::firstReason(outcome.reason));
  }
  void print() const {
    fmt::print(
        "\n{} cases: {} wrong (beyond {} sigmas, and {} deg, {} mm or {} ms), {} of them called ok; the "
        "first "
        "reason names the cause in {} of {} doubtful or failed ones ({} more are right, and doubtful only as "
        "the "
        "same recording is unspoilt: it moves too little); {} of {} unspoilt ones ok\n",
        cases, wrong, kWrongSigmas, kWrongRotation_deg, kWrongTranslation_mm, kWrongTimeOffset_ms, wrong_ok,
        named, nameable, as_unspoilt, ok_unspoilt, unspoilt);
  }
};

void printHeader() {
  fmt::print(
      "| scenario | seed | perturbation | size | rotation, deg (sigma, sigmas) | translation, mm | time "
      "offset, "
      "ms | misfit of circles, gyroscope, accelerometer | outliers, % | halves, sigmas | verdict | first "
      "reason "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

std::string cell(const PartError& error) {
  return fmt::format("{:.3f} ({:.3f}, {:.1f})", error.size, error.sigma, error.sigmas);
}

std::string cells(const Misfit& misfit) {
  return fmt::format("{:.2g} {:.2g} {:.2g} | {:.1f} | {:.1f}", misfit.circles, misfit.gyroscope,
                     misfit.accelerometer, 100.0 * misfit.outliers, misfit.halves_sigmas);
}

void printRow(const Scenario& scenario, const Perturbation& perturbation, double size, const Case& of) {
  const Outcome& outcome = of.outcome;
  const std::string_view reason = test::firstReason(outcome.reason);
  std::string figures = " | | | | | ";
  if (outcome.comparison)
    figures = fmt::format("{} | {} | {} | {}", cell(rotationError_deg(*outcome.comparison)),
                          cell(translationError_mm(*outcome.comparison)),
                          cell(timeOffsetError_ms(*outcome.comparison)), cells(of.misfit));
  fmt::print("| {} | {} | {} | {:g} {} | {} | {}{} | {}{} |\n", scenario.name, scenario.seed,
             perturbation.name, size, perturbation.unit, figures, isWrong(outcome) ? "WRONG, " : "",
             outcome.verdict,
             outcome.verdict == "ok" || perturbation.causes.empty() ? ""
             : perturbation.isNamedIn(reason)                       ? "(named) "
                                                                    : "(other) ",
             reason);
  std::fflush(stdout);
}

struct Arguments {
  ScenarioArguments scenarios;
  std::vector<std::string> only;
  std::optional<double> size;
  Source source;
  bool notes = false;

  void addTo(Command& app) {
    scenarios.addTo(app);
    app.option("--only", only, "Perturbations by name, instead of all");
    app.option("--size", size, "One size of the perturbation, instead of those of the table");
    app.flag("--notes", notes, "Also the notes of each result");
    app.flag("--perfect", source.perfect, "Circles of an ideal front end, without events");
  }
  std::vector<Perturbation> rows() const {
    std::vector<Perturbation> all(test::perturbations().begin(), test::perturbations().end());
    if (!only.empty()) {
      all.clear();
      for (const std::string& name : only) all.push_back(test::perturbation(name));
    }
    // An ideal front end sees the true board, not the session's.
    if (source.perfect)
      std::erase_if(all, [](const Perturbation& each) { return each.stage == PerturbedStage::FrontEnd; });
    for (Perturbation& each : all)
      if (size) each.sizes = {*size};
    return all;
  }
};

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Verdicts if one quantity deviates from the session");
  Arguments arguments;
  arguments.addTo(app);
  if (!app.parse(argc, argv)) return 0;
  printHeader();
  Summary summary;
  for (const std::string& file : arguments.scenarios.files) {
    for (int k = 0; k < arguments.scenarios.seeds; ++k) {
      Recorded base;
      base.scenario = arguments.scenarios.read(file, k);
      base.session = test::sessionFor(base.scenario);
      base.detections = arguments.source.detections(base.scenario, base.session);
      const Outcome twin = calibrated(base).outcome;
      for (const Perturbation& row : arguments.rows()) {
        for (const double size : row.sizes) {
          const Case of = perturbed(base, row, size, arguments.source);
          printRow(base.scenario, row, size, of);
          if (arguments.notes && of.outcome.result)
            fmt::print("{}\n", fmt::join(of.outcome.result->notes, "\n"));
          summary.add(row, of.outcome, twin);
        }
      }
    }
  }
  summary.print();
  return summary.wrong_ok == 0 ? 0 : 1;
}

}  // namespace evical::benchmarks::stress
