#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "core/base/number.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/recording/live/live_player.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/drive_scenario.h"
#include "core/synthetic/scenario_yaml.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace evical {

namespace {

void play(const PlayRequest& request, Console& console, const std::stop_token& stop) {
  const PlaySummary made = playRecording(request, {console, stop});
  console.stageStarted("done");
  print("{}, {} played, at most {:.3f} s late\n", counted(made.events, "event"),
        counted(made.imu_samples, "IMU sample"), made.largest_delay_s);
}

}  // namespace

void addSimulateCommand(Command& app, int& exit_code) {
  struct Arguments {
    std::filesystem::path scenario, folder;
    std::string format;
    PlayRequest play;
    bool quiet = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  Command command =
      app.command("simulate", "Simulate a recording with known truth, and write a session for it");
  command
      .option("SCENARIO", arguments->scenario,
              "Scenario file, e.g. config/scenarios/davis346.yaml, or a recording to serve")
      .required();
  command.option("-o,--output", arguments->folder, "Folder to write");
  std::string formats;
  for (const RecordingFormat& format : recordingFormats())
    formats += fmt::format("{}{}", formats.empty() ? "" : ", ", format.name);
  command.option("--format", arguments->format,
                 "Output format, by default the scenario's; one of " + formats);
  const Argument serve = command.option(
      "--serve", arguments->play.address,
      "Then play the recording to programs on the network, e.g. at tcp://localhost:7777, with one port "
      "for each stream as iniVation's programs have, or as foxglove_bridge at "
      "ws://localhost:8765");
  command.option("--speed", arguments->play.speed, "Speed of playing; by default 1: real time")
      .between(0.01, 1000.0)
      .needs(serve);
  command.flag("--quiet", arguments->quiet, "Print no progress");
  command.example("evical simulate config/scenarios/davis346_10s.yaml -o simulated");
  command.action([arguments, &exit_code] {
    const std::stop_token stop = stopOnSignals();
    PlayRequest& played = arguments->play;
    if (!played.address.empty() && arguments->scenario.extension() != ".yaml") {
      Console console(arguments->quiet);
      played.recording = arguments->scenario;
      play(played, console, stop);
      exit_code = kDone;
      return;
    }
    if (arguments->folder.empty()) throw missingOption("-o,--output");
    const bool drive = isDriveScenario(arguments->scenario);
    const Scenario scenario = drive ? Scenario{} : readScenario(arguments->scenario);
    const DriveScenario imus = drive ? readDriveScenario(arguments->scenario) : DriveScenario{};
    Console console(arguments->quiet);
    console.announceReplacement(arguments->folder, {"session.yaml"});
    const RunContext context{console, stop};
    const SimulationSummary made = drive ? simulateDrive(imus, arguments->folder, context, arguments->format)
                                         : simulate(scenario, arguments->folder, context, arguments->format);
    console.stageStarted("done");
    print("{}, {}, {}\n{}\n{}\n{}\n", counted(made.events, "event"), counted(made.frames, "frame"),
          counted(made.imu_samples, "IMU sample"), made.recording.string(), made.session.string(),
          made.truth.string());
    played.recording = made.recording;
    if (!played.address.empty()) play(played, console, stop);
    exit_code = kDone;
  });
}

}  // namespace evical
