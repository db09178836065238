// What the benchmarks have in common.
#pragma once

#include "app/command_line.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/processor_time.h"

#include <fmt/format.h>

#include <cstdint>
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

  void addTo(Command& app) {
    app.option("SCENARIO", files, "Scenario files").required();
    app.option("--seeds", seeds, "Each scenario with this many seeds").between(1, 1000);
    app.option("--skip", skipped, "So many seeds, which another run has done").between(0, 1000);
    app.option("--duration", duration_s, "Seconds, instead of the scenario's").between(2.0, 3600.0);
  }
  Scenario read(const std::string& file, int k) const {
    Scenario scenario = readScenario(file);
    if (duration_s) scenario.duration_s = *duration_s;
    scenario.seed += static_cast<std::uint64_t>(skipped + k);
    return scenario;
  }
};

namespace benchmarks {

// Work of fixed size, of the kinds that the stages do, which says how fast the machine computes (speed_reference.cpp).
double speedReference();

// One in each source. argv[0] is the benchmark's name; the result is the exit code, 1 where a target is missed.
namespace accuracy {
int run(int argc, char** argv);
}
namespace board_starts {
int run(int argc, char** argv);
}
namespace centre_errors {
int run(int argc, char** argv);
}
namespace check {
int run(int argc, char** argv);
}
namespace costs {
int run(int argc, char** argv);
}
namespace formats {
int run(int argc, char** argv);
}
namespace frame_cameras {
int run(int argc, char** argv);
}
namespace intrinsics {
int run(int argc, char** argv);
}
namespace maintain {
int run(int argc, char** argv);
}
namespace no_board {
int run(int argc, char** argv);
}
namespace protocol {
int run(int argc, char** argv);
}
namespace speed {
int run(int argc, char** argv);
}
namespace speed_guard {
int run(int argc, char** argv);
}
namespace stress {
int run(int argc, char** argv);
}
namespace unknown_intrinsics {
int run(int argc, char** argv);
}
}  // namespace benchmarks

}  // namespace evical
