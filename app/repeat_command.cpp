#include "app/assessment_command.h"
#include "app/commands.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/repeat/repeat_files.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical {
namespace {

struct RepeatArguments : AssessmentArguments {
  std::vector<std::string> sessions;
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

int run(const RepeatArguments& arguments) {
  const RepeatInput input = inputFrom(arguments);
  return runAssessment(arguments, [&](const Console& console, const RunContext& context) {
    return repeatInto(
               arguments.output, input, kVersion, [&] { return console.logText(); }, context)
        .repeatability;
  });
}

}  // namespace

void addRepeatCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<RepeatArguments>();
  Command command =
      app.command("repeat", "Calibrate several recordings of one rig, each alone, then together");
  command
      .option("SESSION", arguments->sessions,
              "Sessions with the same sensors and board, or one that lists several recordings")
      .required();
  addAssessmentArguments(command, *arguments, "Folder for the results",
                         "groups of calibrate, and check, for all sessions")
      .required();
  addThreads(command, *arguments);
  command.example("evical repeat first.yaml second.yaml third.yaml -o repeat");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
