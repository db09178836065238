#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/recording/conversion.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace evical {
namespace {

Resolution resolutionIn(const std::string& text) {
  Resolution size_px;
  const std::size_t cross = text.find('x');
  const auto isSide = [](std::string_view side, int& length_px) {
    const auto [end, error] = std::from_chars(side.data(), side.data() + side.size(), length_px);
    return error == std::errc{} && end == side.data() + side.size() && length_px > 0 && length_px <= 65536;
  };
  const bool good = cross != std::string::npos &&
                    isSide(std::string_view(text).substr(0, cross), size_px.width_px) &&
                    isSide(std::string_view(text).substr(cross + 1), size_px.height_px);
  if (!good) throw badInput(text, "is not a resolution", "Write it as 346x260");
  return size_px;
}

void printSummary(const ConversionRequest& request, const ConversionSummary& made) {
  print("{}, {}{} in {} ({})\n", counted(made.events, "event"), counted(made.imu_samples, "IMU sample"),
        made.frames > 0 ? ", " + counted(made.frames, "frame") : "", request.output.string(), made.format);
  for (const RecordingFault& fault : made.faults)
    print("  {}: {}{}{}\n", nameOf(fault.kind), fault.stream, fault.stream.empty() ? "" : ": ", fault.text);
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
