#include "app/calibrate_command.h"
#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/live_lines.h"
#include "app/session_arguments.h"
#include "core/pipeline/rig/live_watch.h"
#include "core/pipeline/session/session_keys.h"

#include <memory>
#include <string>
#include <vector>

namespace evical {
namespace {

struct WatchArguments {
  SessionArguments session;
  LiveRequest record;
};

int run(const WatchArguments& arguments) {
  WatchRequest request{arguments.record, readSessionOfRun(arguments.session.session)};
  if (request.record.output.empty()) request.record.output = arguments.session.output + ".mcap";
  Console console(arguments.session.quiet);
  console.announceReplacement(arguments.session.output, {"result.yaml"});
  console.announceReplacement(request.record.output.parent_path(),
                              {request.record.output.filename().c_str()});
  const NewFolder folder(arguments.session.output);
  const std::stop_token stop = stopOnSignals();
  LiveLines lines(console);
  WatchedRecording watched = watchLive(request, lines, {console, stop});
  printLiveSummary(request.record, watched.recorded);
  // Ctrl-C has ended the recording, not the calibration.
  CalibrationOutcome outcome =
      runCalibration(watched.session, std::move(watched.detected.detections), RunContext{console});
  return finishCalibration(arguments.session, watched.session, std::move(outcome), console, folder);
}

}  // namespace

void addWatchCommand(Command& app, int& exit_code) {
  const auto arguments = std::make_shared<WatchArguments>();
  Command command = app.command(
      "watch",
      "Record live streams, say which motion is missing, and calibrate when the recording is good enough");
  command.option("SOURCE", arguments->record.sources, "A source of `evical record`. Can be repeated")
      .required();
  command
      .option("--session", arguments->session.session, "Session file of the rig; its recording is not used")
      .required();
  command.option("-o,--output", arguments->session.output, "Folder for the results").required();
  command.option(
      "--recording", arguments->record.output,
      "File for the recording (.mcap, .bag or .aedat4); by default named as the folder, with .mcap");
  command.option("--duration", arguments->record.max_duration_s, "Stop at the latest after this time, in s")
      .between(0.1, 1e6);
  command.flag("--quiet", arguments->session.quiet, "Print no progress");
  command.footer("Ctrl-C ends the recording, and starts the calibration.");
  command.example("evical watch tcp://localhost:7777 tcp://localhost:7778 --session session.yaml -o result");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
