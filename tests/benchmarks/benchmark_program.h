// What the benchmarks' programs have in common.
#pragma once

#include "core/base/error.h"
#include "core/synthetic/scenario_yaml.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Scenarios on the command line, each with some seeds and perhaps another duration.
struct ScenarioArguments {
  std::vector<std::string> files;
  int seeds = 1;
  int skipped = 0;
  std::optional<double> duration_s;

  void addTo(CLI::App& app) {
    app.add_option("SCENARIO", files, "Scenario files")->required();
    app.add_option("--seeds", seeds, "Each scenario with this many seeds")->check(CLI::Range(1, 1000));
    app.add_option("--skip", skipped, "So many seeds, which another run has done")
        ->check(CLI::Range(0, 1000));
    app.add_option("--duration", duration_s, "Seconds, instead of the scenario's")
        ->check(CLI::Range(2.0, 3600.0));
  }
  Scenario read(const std::string& file, int k) const {
    Scenario scenario = readScenario(file);
    if (duration_s) scenario.duration_s = *duration_s;
    scenario.seed += static_cast<std::uint64_t>(skipped + k);
    return scenario;
  }
};

// Of all threads of this process.
inline double processCpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Runs a program; an error is said, and makes its exit code.
inline int guarded(int (*run)(int, char**), int argc, char** argv, int code_of_errors = 2) {
  try {
    return run(argc, argv);
  } catch (const CalibrationError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return code_of_errors;
  }
}

}  // namespace evical
