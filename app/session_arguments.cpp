#include "app/session_arguments.h"

#include "core/base/error.h"
#include "core/base/shell_word.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace evical {

void addSessionArguments(CLI::App& command, SessionArguments& arguments) {
  command.add_option("SESSION", arguments.session, "Session file")->required();
  command.add_option("-o,--output", arguments.output, "Folder for the results")->required();
  command
      .add_option("--set", arguments.settings,
                  "group.option=value, see 'evical options'; imus.NAME.KEY=value of units and axes; or "
                  "time_range_s=[begin,end]")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--threads", arguments.threads, "Threads of the optimisation")
      ->check(CLI::Range(1, 256));
  command.add_flag("--quiet", arguments.quiet, "Only the result and errors");
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
  if (arguments.threads > 0) session.options.optimisation.threads = arguments.threads;
  return session;
}

std::string tryText(const SessionArguments& arguments, const Repair& repair) {
  std::string text = fmt::format("Try: evical calibrate {}", shellWord(arguments.session));
  for (const std::string& setting : arguments.settings)
    if (!setting.starts_with(repair.key + "=")) text += " --set " + shellWord(setting);
  if (!arguments.detections.empty()) text += " --detections " + shellWord(arguments.detections);
  return text + fmt::format(" --set {} -o {}\n", shellWord(repair.text()), shellWord(arguments.output));
}

}  // namespace evical
