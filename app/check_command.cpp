#include "app/assessment_command.h"
#include "app/commands.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/check/check_files.h"
#include "core/pipeline/session/calibration_options.h"

#include <array>
#include <memory>
#include <string>

namespace evical {
namespace {

struct CheckArguments : AssessmentArguments {
  std::string result, recording, session;
  std::array<std::string, 4> stabilities;  // in the order of kStabilities
  bool no_board = false;
};

struct StabilityFlag {
  const char *flag, *option, *help;
};
constexpr std::array<StabilityFlag, 4> kStabilities = {{
    {"--stability-rotation", "check.stability_rotation_deg", "Rotation change that is tolerated, deg"},
    {"--stability-translation", "check.stability_translation_mm", "Translation change that is tolerated, mm"},
    {"--stability-time-offset", "check.stability_time_offset_ms", "Time offset change that is tolerated, ms"},
    {"--stability-lens", "check.stability_lens_px", "Lens change that is tolerated, px RMS over the image"},
}};

CheckInput inputFrom(const CheckArguments& arguments) {
  warnOfForeignRunData(arguments.result);
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
  return runAssessment(arguments, [&](const Console& console, const RunContext& context) {
    CheckRun checked = checkCalibration(input, context);
    checked.check.version = kVersion;
    if (!arguments.output.empty())
      writeCheckFiles(arguments.output, input, checked, kVersion, console.logText());
    return checked.check;
  });
}

}  // namespace

void addCheckCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<CheckArguments>();
  Command command = app.command(
      "check", "Check an old calibration with a new recording of a few seconds, with or without a board");
  command.option("RESULT", arguments->result, "Folder of the old calibration, or its result.yaml").required();
  command.option("RECORDING", arguments->recording, "New recording, or a session of it").required();
  addAssessmentArguments(command, *arguments, "Folder for check.yaml and report.html", "group check");
  command.option("--session", arguments->session,
                 "Session that describes board and sensors; by default the one stored with the result");
  for (std::size_t k = 0; k < kStabilities.size(); ++k)
    command.option(kStabilities[k].flag, arguments->stabilities[k], kStabilities[k].help);
  addThreads(command, *arguments);
  command.flag(
      "--no-board", arguments->no_board,
      "Check a recording without a board: rotation and time offset from the rotation of camera and IMU");
  command.example("evical check result new_recording.bag -o check");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
