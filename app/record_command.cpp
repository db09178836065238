#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/live_lines.h"
#include "app/session_arguments.h"
#include "core/pipeline/rig/live_watch.h"
#include "core/pipeline/session/session_keys.h"

#include <memory>
#include <string>

namespace evical {
void addRecordCommand(Command& app, int& exit_code) {
  struct Arguments {
    LiveRequest request;
    std::string resolution, session;
    bool until_good = false, quiet = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  LiveRequest& request = arguments->request;
  Command command = app.command("record", "Record live streams into one file, until Ctrl-C");
  command
      .option("SOURCE", request.sources,
              "tcp://HOST:PORT or unix:///PATH of iniVation's programs, ws://HOST:PORT of foxglove_bridge, "
              "\"-\" for the standard input, or a "
              "file that is still being written. Can be repeated")
      .required();
  command.option("-o,--output", request.output, "File to write (.mcap, .bag or .aedat4)").required();
  command.option("--to", request.format, "Output format; by default from the extension");
  command.option("--duration", request.max_duration_s, "Stop after this time, in s").between(0.1, 1e6);
  command.option("--resolution", arguments->resolution,
                 "Resolution of the sensor, e.g. 346x260, if the stream does not contain it");
  const Argument session = command.option("--session", arguments->session,
                                          "Session file of the rig: the recording is assessed meanwhile");
  command
      .flag("--until-good", arguments->until_good, "Stop when the recording is good enough for a calibration")
      .needs(session);
  command.flag("--quiet", arguments->quiet, "Print no progress");
  command.example(
      "evical record tcp://localhost:7777 tcp://localhost:7778 -o recording.aedat4 --duration 40");
  command.action([arguments, &exit_code] {
    if (!arguments->resolution.empty())
      arguments->request.resolution_px = resolutionIn(arguments->resolution);
    Console console(arguments->quiet);
    const std::filesystem::path& output = arguments->request.output;
    console.announceReplacement(output.parent_path(), {output.filename().c_str()});
    const RunContext context{console, stopOnSignals()};
    LiveLines lines(console);
    const LiveSummary made =
        arguments->session.empty()
            ? recordLive(arguments->request, context)
            : watchLive({arguments->request, readSessionOfRun(arguments->session), arguments->until_good},
                        lines, context)
                  .recorded;
    console.stageStarted("done");
    printLiveSummary(arguments->request, made);
    exit_code = kDone;
  });
}

}  // namespace evical
