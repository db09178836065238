#include "app/session_arguments.h"
#include "app/command_line.h"
#include "app/output.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/plain_text.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/runs/saved_run.h"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

namespace evical {

void addSessionArguments(Command& command, SessionArguments& arguments) {
  command.option("SESSION", arguments.session, "Session file").required();
  command.option("-o,--output", arguments.output, "Folder for the results").required();
  command
      .option("--set", arguments.settings,
              "group.option=value, see 'evical options'; imus.NAME.KEY=value for units and axes; or "
              "time_range_s=[begin,end]. Can be repeated")
      .repeated();
  command.option("--threads", arguments.threads, "Threads of the optimisation").between(1, 256);
  command.flag("--quiet", arguments.quiet, "Print only the result and errors");
}

void applySettings(const std::vector<std::string>& settings, Session& session) {
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw badInput("--set " + setting, "has no '='", "Write --set group.option=value");
    }
    setInSession(session, setting.substr(0, equals), setting.substr(equals + 1));
  }
  validate(session.options);
}

Session sessionFrom(const SessionArguments& arguments) {
  Session session = readSession(arguments.session);
  applySettings(arguments.settings, session);
  if (arguments.threads > 0) session.options.optimisation.edit().threads = arguments.threads;
  return session;
}

std::string tryText(const SessionArguments& arguments, const Repair& repair) {
  std::string text = fmt::format("Try: evical calibrate {}", shellWord(arguments.session));
  for (const std::string& setting : arguments.settings)
    if (!setting.starts_with(repair.key + "=")) text += " --set " + shellWord(setting);
  if (!arguments.detections.empty()) text += " --detections " + shellWord(arguments.detections);
  return text + fmt::format(" --set {} -o {}\n", shellWord(repair.text()), shellWord(arguments.output));
}

std::vector<std::string> foldersOfCameras(const Session& session) {
  std::vector<std::string> names;
  for (const SessionCamera& camera : session.cameras) names.push_back(camera.name);
  return foldersOfNames(names);
}

void warnOfForeignRunData(const std::string& path) {
  const std::filesystem::path file = resultFileOf(path);
  if (file.filename() != kResultFile) return;
  if (const std::optional<std::string> why = whyRunDataIsForeign(file))
    printError(fmt::format("warning: {}: {}\n", file.string(), *why));
}

NamedResult resultAt(const std::string& path) {
  warnOfForeignRunData(path);
  return readResultYaml(resultFileOf(path));
}

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

void printFaults(const std::vector<RecordingFault>& faults) {
  for (const RecordingFault& fault : faults)
    print("  {}: {}{}{}\n", nameOf(fault.kind), fault.stream, fault.stream.empty() ? "" : ": ", fault.text);
}

}  // namespace evical
