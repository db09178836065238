#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "core/base/number.h"
#include "core/recording/live/live_recording.h"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace evical {
namespace {

void printSummary(const LiveRequest& request, const LiveSummary& made) {
  print("{:.1f} s, {}, {}{} in {} ({})\n", made.duration_s, counted(made.events, "event"),
        counted(made.imu_samples, "IMU sample"), made.frames > 0 ? ", " + counted(made.frames, "frame") : "",
        request.output.string(), made.format);
  printFaults(made.faults);
}

}  // namespace

void addRecordCommand(Command& app, int& exit_code) {
  struct Arguments {
    LiveRequest request;
    std::string resolution;
    bool quiet = false;
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
  command.option("--duration", request.max_duration_s, "Stop after this time, in s");
  command.option("--resolution", arguments->resolution,
                 "Resolution of the sensor, e.g. 346x260, if the stream does not contain it");
  command.flag("--quiet", arguments->quiet, "Print no progress");
  command.example(
      "evical record tcp://localhost:7777 tcp://localhost:7778 -o recording.aedat4 --duration 40");
  command.action([arguments, &exit_code] {
    if (!arguments->resolution.empty())
      arguments->request.resolution_px = resolutionIn(arguments->resolution);
    Console console(arguments->quiet);
    const std::filesystem::path& output = arguments->request.output;
    console.announceReplacement(output.parent_path(), {output.filename().c_str()});
    const LiveSummary made = recordLive(arguments->request, {console, stopOnSignals()});
    console.stageStarted("done");
    printSummary(arguments->request, made);
    exit_code = kDone;
  });
}

}  // namespace evical
