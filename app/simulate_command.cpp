#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "core/base/number.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/drive_scenario.h"
#include "core/synthetic/scenario_yaml.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace evical {

void addSimulateCommand(Command& app, int& exit_code) {
  struct Arguments {
    std::filesystem::path scenario, folder;
    std::string format;
    bool quiet = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  Command command =
      app.command("simulate", "Simulate a recording with known truth, and write a session for it");
  command.option("SCENARIO", arguments->scenario, "Scenario file, e.g. config/scenarios/davis346.yaml")
      .required();
  command.option("-o,--output", arguments->folder, "Folder to write").required();
  std::string formats;
  for (const RecordingFormat& format : recordingFormats())
    formats += fmt::format("{}{}", formats.empty() ? "" : ", ", format.name);
  command.option("--format", arguments->format,
                 "Output format, by default the scenario's; one of " + formats);
  command.flag("--quiet", arguments->quiet, "Print no progress");
  command.example("evical simulate config/scenarios/davis346_10s.yaml -o simulated");
  command.action([arguments, &exit_code] {
    const bool drive = isDriveScenario(arguments->scenario);
    const Scenario scenario = drive ? Scenario{} : readScenario(arguments->scenario);
    const DriveScenario imus = drive ? readDriveScenario(arguments->scenario) : DriveScenario{};
    Console console(arguments->quiet);
    console.announceReplacement(arguments->folder, {"session.yaml"});
    const RunContext context{console, stopOnSignals()};
    const SimulationSummary made = drive ? simulateDrive(imus, arguments->folder, context, arguments->format)
                                         : simulate(scenario, arguments->folder, context, arguments->format);
    console.stageStarted("done");
    print("{}, {}, {}\n{}\n{}\n{}\n", counted(made.events, "event"), counted(made.frames, "frame"),
          counted(made.imu_samples, "IMU sample"), made.recording.string(), made.session.string(),
          made.truth.string());
    exit_code = kDone;
  });
}

}  // namespace evical
