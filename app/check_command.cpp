#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/base/error.h"
#include "core/base/new_folder.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/check/check_files.h"
#include "core/pipeline/session/check_options.h"
#include "core/report/check_report.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evical {
namespace {

struct CheckArguments {
  std::string result, recording, session, output;
  std::vector<std::string> settings;
  std::array<std::string, 4> stabilities;  // as kStabilities
  int threads = 0;
  bool json = false, quiet = false, no_board = false;
};

struct StabilityFlag {
  const char *flag, *option, *help;
};
constexpr std::array<StabilityFlag, 4> kStabilities = {{
    {"--stability-rotation", "check.stability_rotation_deg", "What rotations may change by, deg"},
    {"--stability-translation", "check.stability_translation_mm", "What translations may change by, mm"},
    {"--stability-time-offset", "check.stability_time_offset_ms", "What time offsets may change by, ms"},
    {"--stability-lens", "check.stability_lens_px", "What lenses may change by, px RMS over the image"},
}};

int exitCodeOf(CheckVerdict verdict) {
  switch (verdict) {
    case CheckVerdict::StillGood:
      return kDone;
    case CheckVerdict::Changed:
      return kChanged;
    case CheckVerdict::CannotTell:
      break;
  }
  return kCannotTell;
}

CheckInput inputFrom(const CheckArguments& arguments) {
  CheckInput input = readCheckInput({arguments.result, arguments.recording, arguments.session});
  for (std::size_t k = 0; k < kStabilities.size(); ++k)
    if (!arguments.stabilities[k].empty())
      setInSession(input.session, kStabilities[k].option, arguments.stabilities[k]);
  applySettings(arguments.settings, input.session);
  if (arguments.no_board) {
    CheckOptions options = *input.session.options.check;
    options.no_board = true;
    input.session.options.check = options;
  }
  if (arguments.threads > 0) input.session.options.optimisation.edit().threads = arguments.threads;
  return input;
}

int run(const CheckArguments& arguments) {
  const CheckInput input = inputFrom(arguments);
  Console console(arguments.quiet || arguments.json);
  std::optional<NewFolder> folder;
  if (!arguments.output.empty()) folder.emplace(arguments.output);
  CheckRun checked = checkCalibration(input, RunContext{console, stopOnSignals()});
  checked.check.version = kVersion;
  if (folder) writeCheckFiles(arguments.output, input, checked, kVersion, console.logText());
  console.stageStarted("done");
  print("{}", arguments.json ? checkJson(checked.check) : checkTable(checked.check));
  if (folder && !arguments.quiet && !arguments.json) print("Files are in {}\n", arguments.output);
  return exitCodeOf(checked.check.verdict);
}

}  // namespace

void addCheckCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<CheckArguments>();
  Command command = app.command(
      "check",
      "Is an old calibration still good? A few seconds before the board tell, or a walk without one");
  command.option("RESULT", arguments->result, "Folder of the old calibration, or its result.yaml").required();
  command.option("RECORDING", arguments->recording, "The new recording, or a session of it").required();
  command.option("-o,--output", arguments->output, "Folder for check.yaml and report.html");
  command.option("--session", arguments->session,
                 "Session that says board and sensors; without it the one that is kept beside the result");
  for (std::size_t k = 0; k < kStabilities.size(); ++k)
    command.option(kStabilities[k].flag, arguments->stabilities[k], kStabilities[k].help);
  command.option("--set", arguments->settings, "group.option=value, see 'evical options': the group is check")
      .repeated();
  command.option("--threads", arguments->threads, "Threads of the optimisation").between(1, 256);
  command.flag("--no-board", arguments->no_board,
               "The recording shows no board: check rotation and time offset by how camera and IMU turn");
  command.flag("--json", arguments->json, "Print JSON instead of tables, and nothing else");
  command.flag("--quiet", arguments->quiet, "Only the tables and errors");
  command.footer(
      "Exit codes: 0 still good; 3 changed; 4 cannot tell, the last lines say what to do; 1 cancelled; 2 bad "
      "usage, "
      "result or recording.");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
