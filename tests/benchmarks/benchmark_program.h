// Common parts of the benchmarks.
#pragma once

#include "app/command_line.h"
#include "core/base/error.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/processor_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Scenarios on the command line, each with a number of seeds and optionally another duration.
struct ScenarioArguments {
  std::vector<std::string> files;
  int seeds = 1;
  int skipped = 0;
  std::optional<double> duration_s;

  void addTo(Command& app) {
    app.option("SCENARIO", files, "Scenario files").required();
    app.option("--seeds", seeds, "Number of seeds per scenario").between(1, 1000);
    app.option("--skip", skipped, "Number of first seeds to skip").between(0, 1000);
    app.option("--duration", duration_s, "Duration of recordings, s; by default the scenario's")
        .between(2.0, 3600.0);
  }
  Scenario read(const std::string& file, int k) const {
    Scenario scenario = readScenario(file);
    if (duration_s) scenario.duration_s = *duration_s;
    scenario.seed += static_cast<std::uint64_t>(skipped + k);
    return scenario;
  }
};

// Calls visit(name, value) for each setting of "NAME=VALUE,NAME=VALUE". Throws CalibrationError (BadInput).
template <class Visit>
void forEachSetting(const std::string& variant, const Visit& visit) {
  for (std::size_t begin = 0; begin < variant.size();) {
    const std::size_t end = std::min(variant.find(',', begin), variant.size());
    const std::string setting = variant.substr(begin, end - begin);
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw badInput("--variant " + variant, "is not a setting",
                     "Write group.option=value,group.option=value");
    visit(setting.substr(0, equals), setting.substr(equals + 1));
    begin = end + 1;
  }
}

namespace benchmarks {

// A fixed amount of work of the same kinds as in the stages, to measure the machine's speed
// (speed_reference.cpp).
double speedReference();

// One function per source. argv[0] is the benchmark's name; the result is the exit code, 1 if a target is
// missed.
namespace accuracy {
int run(int argc, char** argv);
}
namespace board_starts {
int run(int argc, char** argv);
}
namespace boards {
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
namespace laboratories {
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
