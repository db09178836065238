// Cost of whole calibrations against duration, events, cameras and IMUs, as a table: `evical_benchmarks costs
// [--recording FOLDER] [--scratch FOLDER] [SCENARIO...] [--durations S...]`. A scenario is simulated once
// into a file, for the longest duration, and its first seconds are calibrated in a separate process each
// time. With several durations, the growth exponent is printed.
#include "core/base/time.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/report/result_yaml.h"
#include "tests/benchmarks/benchmark_program.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QTemporaryDir>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace evical::benchmarks::costs {
namespace {

struct Cost {
  double wall_s = 0.0, cpu_s = 0.0, memory_mb = 0.0;
  std::uint64_t events = 0;
  std::string verdict;
};

// Figures that the other process prints.
struct Told {
  std::uint64_t events = 0;
  CalibrationStatus status = CalibrationStatus::Failed;
};

Told told(const Session& session) {
  const CalibrationRun run = calibrate(session, {});
  Told result{0, run.result.status};
  for (const BoardObservations& camera : run.detections.cameras) result.events += camera.events;
  return result;
}

// Runs in a separate process, since memory is counted per process.
Cost costOf(const Session& session) {
  int ends[2];
  if (::pipe(ends) != 0) throw badInput("pipe", "no process can be watched");
  const Stopwatch stopwatch;
  const pid_t child = ::fork();
  if (child < 0) throw badInput("fork", "no process can be made");
  if (child == 0) {
    int code = 1;
    try {
      const Told result = told(session);
      code = ::write(ends[1], &result, sizeof result) == static_cast<ssize_t>(sizeof result) ? 0 : 1;
    } catch (const CalibrationError& error) {
      fmt::print(stderr, "{}\n", error.what());
    }
    ::_exit(code);
  }
  ::close(ends[1]);
  Told result;
  const bool whole = ::read(ends[0], &result, sizeof result) == static_cast<ssize_t>(sizeof result);
  ::close(ends[0]);
  rusage usage{};
  int status = 0;
  ::wait4(child, &status, 0, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  constexpr double kMbPerKib = 1024.0 / 1e6;
  Cost cost{stopwatch.elapsed_s(), seconds(usage.ru_utime) + seconds(usage.ru_stime),
            kMbPerKib * static_cast<double>(usage.ru_maxrss), result.events, "failed"};
  if (whole) cost.verdict = statusName(result.status);
  return cost;
}

// Slope in log-log scale.
double exponent(const std::vector<double>& durations_s, const std::vector<Cost>& costs) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(costs.size());
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const double a = std::log(durations_s[k]), b = std::log(costs[k].cpu_s);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void table(const std::string& name, Session session, const std::vector<double>& durations_s) {
  std::vector<Cost> costs;
  for (const double duration_s : durations_s) {
    session.time_range_s = {0.0, duration_s};
    const Cost& cost = costs.emplace_back(costOf(session));
    fmt::print("| {} | {} | {} | {:.0f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {} |\n", name,
               session.cameras.size(), session.imus.size(), duration_s,
               1e-6 * static_cast<double>(cost.events), cost.wall_s, cost.cpu_s, cost.memory_mb,
               cost.verdict);
    std::fflush(stdout);
  }
  if (costs.size() > 1)
    fmt::print(
        "\n{}: processor time grows with the duration to the power {:.2f}, memory by {:.1f} MB per "
        "second\n\n",
        name, exponent(durations_s, costs),
        (costs.back().memory_mb - costs.front().memory_mb) / (durations_s.back() - durations_s.front()));
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Cost of whole calibrations against the recording's duration");
  std::vector<std::string> files;
  std::vector<double> durations_s;
  std::string recording, scratch;
  app.option("SCENARIO", files, "Scenario files");
  app.option("--durations", durations_s, "Durations of the recording, s; by default the scenario's")
      .between(2.0, 3600.0);
  app.option("--recording", recording, "Folder with a session and its recording, instead of a scenario");
  app.option("--scratch", scratch, "Folder for recordings; by default a temporary one");
  if (!app.parse(argc, argv)) return 0;
  std::sort(durations_s.begin(), durations_s.end());
  QTemporaryDir folder;
  if (scratch.empty()) scratch = folder.path().toStdString();
  fmt::print(
      "| recording | cameras | IMUs | duration, s | events, millions | wall, s | CPU, s | memory, MB | "
      "verdict |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  if (!recording.empty())
    table(recording, readSession(std::filesystem::path(recording) / "session.yaml"), durations_s);
  for (const std::string& file : files) {
    Scenario scenario = readScenario(file);
    if (!durations_s.empty()) scenario.duration_s = durations_s.back();
    const SimulationSummary made = simulate(scenario, std::filesystem::path(scratch) / scenario.name, {});
    table(scenario.name, readSession(made.session),
          durations_s.empty() ? std::vector<double>{scenario.duration_s} : durations_s);
  }
  return 0;
}

}  // namespace evical::benchmarks::costs
