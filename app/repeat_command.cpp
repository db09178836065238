#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/base/error.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/repeat/repeat_files.h"
#include "core/report/repeat_report.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical {
namespace {

struct RepeatArguments {
  std::vector<std::string> sessions, settings;
  std::string output;
  int threads = 0;
  bool json = false, quiet = false;
};

RepeatInput inputFrom(const RepeatArguments& arguments) {
  const std::vector<std::filesystem::path> files(arguments.sessions.begin(), arguments.sessions.end());
  RepeatInput input = readRepeat(files);
  for (Session& session : input.sessions) {
    applySettings(arguments.settings, session);
    if (arguments.threads > 0) session.options.optimisation.edit().threads = arguments.threads;
  }
  return input;
}

int exitCodeOf(RepeatVerdict verdict) {
  switch (verdict) {
    case RepeatVerdict::Agree:
      return kDone;
    case RepeatVerdict::Disagree:
      return kChanged;
    case RepeatVerdict::Failed:
      break;
  }
  return kFailed;
}

int run(const RepeatArguments& arguments) {
  const RepeatInput input = inputFrom(arguments);
  Console console(arguments.quiet || arguments.json);
  const RepeatRun repeat = repeatInto(
      arguments.output, input, kVersion, [&] { return console.logText(); },
      RunContext{console, stopOnSignals()});
  console.stageStarted("done");
  print("{}", arguments.json ? repeatJson(repeat.repeatability) : repeatTable(repeat.repeatability));
  if (!arguments.quiet && !arguments.json) print("Files are in {}\n", arguments.output);
  if (repeat.repeatability.verdict == RepeatVerdict::Failed)
    throw calibrationFailed("repeat", repeat.repeatability.reason, "See the reasons, and record again");
  return exitCodeOf(repeat.repeatability.verdict);
}

}  // namespace

void addRepeatCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<RepeatArguments>();
  Command command = app.command("repeat", "Several recordings of one rig: each alone, then all together");
  command
      .option("SESSION", arguments->sessions,
              "Sessions of the same sensors and board, or one that lists recordings")
      .required();
  command.option("-o,--output", arguments->output, "Folder for the results").required();
  command
      .option("--set", arguments->settings,
              "group.option=value of all sessions, see 'evical options'; the groups are those of calibrate, "
              "and check")
      .repeated();
  command.option("--threads", arguments->threads, "Threads of the optimisation").between(1, 256);
  command.flag("--json", arguments->json, "Print JSON instead of tables, and nothing else");
  command.flag("--quiet", arguments->quiet, "Only the tables and errors");
  command.footer(
      "Exit codes: 0 they agree; 3 they do not, the last line says which; 1 cancelled, or fewer than two "
      "could be "
      "calibrated; 2 bad usage, session or recording.");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
