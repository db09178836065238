// The protocol of eKalibr's papers in simulation: several recordings of each board, each calibrated alone,
// and the scatter of the results. `evical_benchmarks protocol [--recordings N] [--duration S] [--only PART]
// [--folder DIR] config/protocol`. Rigs are processed as by `evical repeat`, lenses of single cameras
// (scenarios without given intrinsics) as by `evical intrinsics`. Recordings are simulated one by one and
// then removed. Fails if one cannot be calibrated, or if results disagree.
#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/intrinsics_result.h"
#include "core/numerics/angles.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/repeat/repeat_calibration.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/report/truth_comparison.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/support/scenario_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace evical::benchmarks::protocol {
namespace {

struct Arguments {
  std::string scenarios, only, folder = "protocol";
  int recordings = 5;
  std::optional<double> duration_s;

  void addTo(Command& app) {
    app.option("SCENARIOS", scenarios, "Folder of scenarios, one for each board and rig").required().folder();
    app.option("--recordings", recordings, "Number of recordings of each kind").between(2, 100);
    app.option("--duration", duration_s, "Duration of recordings, s; by default the scenarios'")
        .between(3.0, 3600.0);
    app.option("--only", only, "Only scenarios whose names contain this text");
    app.option("--folder", folder, "Folder for recordings, of which one exists at a time");
  }
  Scenario read(const std::filesystem::path& file, int k) const {
    Scenario scenario = readScenario(file);
    if (duration_s) scenario.duration_s = *duration_s;
    scenario.seed += static_cast<std::uint64_t>(k);
    return scenario;
  }
};

// A typical user's recording of the required length.
class SimulatedRecording {
 public:
  SimulatedRecording(const Scenario& scenario, const std::filesystem::path& folder) : folder_(folder) {
    session = readSession(simulate(scenario, folder, {}).session);
  }
  ~SimulatedRecording() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  SimulatedRecording(const SimulatedRecording&) = delete;
  SimulatedRecording& operator=(const SimulatedRecording&) = delete;

  Session session;

 private:
  std::filesystem::path folder_;
};

struct Protocol {
  bool good = true;
  double calibrating_s = 0.0;
};

// Mean over the axes, or over focal lengths.
double rmsOf(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double each : values) squares += each * each;
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

struct Spread {
  std::vector<double> deviations, sigmas, joint_sigmas;
};

Spread spreadOf(const Repeatability& repeat, const std::string& name) {
  Spread spread;
  for (const RepeatedQuantity& quantity : repeat.quantities)
    if (quantity.name == name)
      for (const RepeatedNumber& number : quantity.numbers) {
        if (number.count < 2) continue;
        spread.deviations.push_back(number.deviation);
        spread.sigmas.push_back(number.mean_sigma);
        spread.joint_sigmas.push_back(number.joint_sigma);
      }
  return spread;
}

std::string cell(const Spread& spread, double factor, int decimals) {
  return fmt::format("{:.{}f} ({:.{}f})", factor * rmsOf(spread.deviations), decimals,
                     factor * rmsOf(spread.sigmas), decimals);
}

Protocol runRig(const std::filesystem::path& file, const Arguments& arguments) {
  std::vector<Session> sessions;
  for (int k = 0; k < arguments.recordings; ++k) {
    Session session = test::sessionFor(arguments.read(file, k));
    session.source = file;
    session.recording = fmt::format("recording{}.bag", k + 1);
    sessions.push_back(std::move(session));
  }
  Protocol protocol;
  const RepeatRun run = repeatCalibration(
      repeatOf(std::move(sessions)),
      [&](std::size_t k, const Session&, const RunContext& context) {
        const SimulatedRecording recording(arguments.read(file, static_cast<int>(k)), arguments.folder);
        const Stopwatch stopwatch;
        CalibrationOutcome outcome = runCalibration(sessionOfRepeat(recording.session), context);
        protocol.calibrating_s += stopwatch.elapsed_s();
        return outcome;
      },
      {}, {});
  const Repeatability& repeat = run.repeatability;
  const Spread rotation = spreadOf(repeat, "rotation"), translation = spreadOf(repeat, "translation"),
               offset = spreadOf(repeat, "time_offset");
  constexpr double kCentimetres = 0.1;  // from mm
  std::string joint = "-";
  if (run.joint) {
    const TruthComparison truth = compareWithTruth(
        *run.joint, test::truthOf(arguments.read(file, static_cast<int>(run.own_values_of))));
    double rotation_deg = 0.0, translation_mm = 0.0;
    for (const CameraError& camera : truth.cameras) {
      rotation_deg = std::max(rotation_deg, camera.rotation_deg);
      translation_mm = std::max(translation_mm, camera.translation_mm);
    }
    joint = fmt::format("{:.4f}, {:.4f} ({:.2f})", rotation_deg, kCentimetres * translation_mm,
                        truth.normalisedRms());
  }
  protocol.good = repeat.verdict == Verdict::Unchanged &&
                  repeat.columns.size() == static_cast<std::size_t>(arguments.recordings);
  fmt::print("| {} | {} | {} | {} | {} | {:.2f} | {} | {:.0f} | {} |\n", file.stem().string(),
             repeat.columns.size(), cell(rotation, 1.0, 4), cell(translation, kCentimetres, 4),
             cell(offset, 1.0, 4), repeat.rms_ratio, joint, protocol.calibrating_s, repeat.reason);
  std::fflush(stdout);
  for (const RepeatedRecording& recording : repeat.recordings)
    if (recording.outcome != RepeatOutcome::Fits)
      fmt::print(stderr, "{}: {}: {}\n", file.stem().string(), recording.name, recording.reason);
  return protocol;
}

// Scatter of one intrinsic parameter over recordings.
struct Scatter {
  double deviation = 0.0, sigma = 0.0;
};
Scatter scatterOf(const std::vector<IntrinsicsResult>& results, int number) {
  double mean = 0.0, squares = 0.0, variances = 0.0;
  const auto count = static_cast<double>(results.size());
  const auto valueOf = [&](const IntrinsicsResult& result) {
    IntrinsicsVector numbers;
    writeIntrinsics(result.intrinsics, numbers.data());
    return numbers[number];
  };
  for (const IntrinsicsResult& result : results) {
    mean += valueOf(result) / count;
    variances += result.covariance(number, number) / count;
  }
  for (const IntrinsicsResult& result : results) squares += std::pow(valueOf(result) - mean, 2);
  return {std::sqrt(squares / (count - 1.0)), std::sqrt(variances)};
}

Protocol runLens(const std::filesystem::path& file, const Arguments& arguments) {
  Protocol protocol;
  std::vector<IntrinsicsResult> results;
  for (int k = 0; k < arguments.recordings; ++k) {
    const SimulatedRecording recording(arguments.read(file, k), arguments.folder);
    const Stopwatch stopwatch;
    results.push_back(calibrateIntrinsics(recording.session, 0, {}).result);
    protocol.calibrating_s += stopwatch.elapsed_s();
  }
  fmt::print("| {} | {} |", file.stem().string(), results.size());
  std::vector<double> ratios;
  for (int number = 0; number < 8; ++number) {
    const Scatter scatter = scatterOf(results, number);
    const int decimals = number < 4 ? 4 : 5;
    fmt::print(" {:.{}f} ({:.{}f}) |", scatter.deviation, decimals, scatter.sigma, decimals);
    if (scatter.sigma > 0.0) ratios.push_back(scatter.deviation / scatter.sigma);
  }
  fmt::print(" {:.2f} | {:.0f} |\n", rmsOf(ratios), protocol.calibrating_s);
  std::fflush(stdout);
  return protocol;
}

bool isLensAlone(const std::filesystem::path& file) {
  return !readScenario(file).intrinsics_in_session;
}

std::vector<std::filesystem::path> scenariosOf(const Arguments& arguments) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(arguments.scenarios))
    if (entry.path().extension() == ".yaml" &&
        entry.path().stem().string().find(arguments.only) != std::string::npos)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw badInput(arguments.scenarios, "has no scenario of that name",
                   "Omit --only, or give a part of a scenario's name");
  return files;
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("The papers' protocol in simulation");
  Arguments arguments;
  arguments.addTo(app);
  if (!app.parse(argc, argv)) return 0;
  const Stopwatch stopwatch;
  Protocol all;
  const auto add = [&](const Protocol& one) {
    all.good = all.good && one.good;
    all.calibrating_s += one.calibrating_s;
  };
  std::vector<std::filesystem::path> lenses, rigs;
  for (const std::filesystem::path& file : scenariosOf(arguments))
    (isLensAlone(file) ? lenses : rigs).push_back(file);
  if (!rigs.empty())
    fmt::print(
        "Standard deviation over recordings (mean sigma), RMS over axes:\n\n| scenario | recordings | "
        "rotation, deg | "
        "translation, cm | time offset, ms | ratio | together against the truth: deg, cm (errors by sigmas) "
        "| "
        "calibrating, s | |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& file : rigs) add(runRig(file, arguments));
  if (!lenses.empty())
    fmt::print(
        "\n| scenario | recordings | fx, px | fy, px | cx, px | cy, px | k1 | k2 | p1 | p2 | ratio | "
        "calibrating, s "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& file : lenses) add(runLens(file, arguments));
  fmt::print("\n{:.0f} s in total, {:.0f} s of them for calibrations\n", stopwatch.elapsed_s(),
             all.calibrating_s);
  return all.good ? 0 : 1;
}

}  // namespace evical::benchmarks::protocol
