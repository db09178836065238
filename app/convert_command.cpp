#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/recording/conversion.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace evical {
namespace {

void printSummary(const ConversionRequest& request, const ConversionSummary& made) {
  print("{}, {}{} in {} ({})\n", counted(made.events, "event"), counted(made.imu_samples, "IMU sample"),
        made.frames > 0 ? ", " + counted(made.frames, "frame") : "", request.output.string(), made.format);
  printFaults(made.faults);
}

}  // namespace

void addConvertCommand(Command& app, int& exit_code) {
  struct Arguments {
    ConversionRequest request;
    std::string resolution;
    bool quiet = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  ConversionRequest& request = arguments->request;
  Command command = app.command("convert", "Convert a recording to another format");
  command.option("RECORDING", request.input, "Recording in any format that `evical inspect` reads")
      .required();
  command.option("-o,--output", request.output, "File or folder to write").required();
  std::string formats;
  for (const RecordingFormat& format : recordingFormats())
    formats += fmt::format("{}{} ({})", formats.empty() ? "" : ", ", format.name, format.description);
  command.option("--to", request.format, "Output format; by default from the extension: " + formats);
  command.option("--stream", request.streams, "Name of a stream to write; by default all. Can be repeated");
  command.option("--resolution", arguments->resolution,
                 "Resolution of the sensor, e.g. 346x260, if the recording does not contain it");
  command.flag("--quiet", arguments->quiet, "Print no progress");
  command.example("evical convert recording.aedat4 -o recording.bag");
  command.action([arguments, &exit_code] {
    if (!arguments->resolution.empty())
      arguments->request.resolution_px = resolutionIn(arguments->resolution);
    Console console(arguments->quiet);
    const std::filesystem::path& output = arguments->request.output;
    std::error_code ignored;
    if (!std::filesystem::is_directory(output, ignored))
      console.announceReplacement(output.parent_path(), {output.filename().c_str()});
    const ConversionSummary made = convertRecording(arguments->request, {console, stopOnSignals()});
    console.stageStarted("done");
    printSummary(arguments->request, made);
    exit_code = kDone;
  });
}

}  // namespace evical
