// Accuracy and speed as tables, one benchmark per source: `evical_benchmarks NAME [OPTIONS]`. Run by
// packaging/benchmarks.sh, and a few of them in short form by ctest.
#include "tests/benchmarks/benchmark_program.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string_view>

namespace evical::benchmarks {
namespace {

struct Benchmark {
  std::string_view name;
  int (*run)(int, char**);
  std::string_view description;
};

constexpr std::array<Benchmark, 17> kBenchmarks = {{
    {"accuracy", accuracy::run, "Accuracy on simulated recordings against their truth"},
    {"board_starts", board_starts::run, "Identification of the board from any start time"},
    {"boards", boards::run, "Boards of squares before event cameras"},
    {"centre_errors", centre_errors::run,
     "Errors of circle centres along the motion, on simulated recordings"},
    {"check", check::run, "evical check on simulated pairs of recordings"},
    {"costs", costs::run, "Cost of whole calibrations against the recording's duration"},
    {"formats", formats::run, "Decoding speed per format"},
    {"frame_cameras", frame_cameras::run,
     "Accuracy of frame cameras, further boards and lenses, against targets"},
    {"intrinsics", intrinsics::run, "Intrinsics of simulated recordings against their truth"},
    {"laboratories", laboratories::run, "Calibrations of random rigs against the truth"},
    {"maintain", maintain::run, "Accuracy of `evical maintain`"},
    {"no_board", no_board::run, "Old calibrations checked without a board"},
    {"protocol", protocol::run, "The papers' protocol in simulation"},
    {"speed", speed::run, "Costs of the hot paths, in CPU time"},
    {"speed_guard", speed_guard::run, "Guards against stages that become slower"},
    {"stress", stress::run, "Verdicts if one quantity deviates from the session"},
    {"unknown_intrinsics", unknown_intrinsics::run,
     "Calibrations with and without intrinsics, against the truth of simulated recordings"},
}};

int usage(std::FILE* stream, int exit_code) {
  fmt::print(
      stream,
      "Usage: evical_benchmarks NAME [OPTIONS]; a benchmark's options: evical_benchmarks NAME --help\n\n");
  for (const Benchmark& benchmark : kBenchmarks)
    fmt::print(stream, "  {:<20} {}\n", benchmark.name, benchmark.description);
  return exit_code;
}

int runNamed(int argc, char** argv) {
  const std::string_view name = argc > 1 ? argv[1] : "";
  if (name == "--help") return usage(stdout, 0);
  for (const Benchmark& benchmark : kBenchmarks)
    if (benchmark.name == name) return benchmark.run(argc - 1, argv + 1);
  return usage(stderr, 2);
}

}  // namespace
}  // namespace evical::benchmarks

int main(int argc, char** argv) {
  try {
    return evical::benchmarks::runNamed(argc, argv);
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
