#include "app/assessment_command.h"
#include "app/commands.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/base/error.h"
#include "core/pipeline/maintain/maintain_files.h"
#include "core/pipeline/maintain/maintain_imus.h"
#include "core/pipeline/session/calibration_options.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace evical {
namespace {

struct MaintainArguments : AssessmentArguments {
  std::vector<std::string> logs, imus;
  std::string result, trajectory, acceleration_unit, angular_rate_unit;
};

std::pair<std::string, std::string> splitAtEquals(const std::string& flag, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw badInput(flag + " " + text, "is not NAME=VALUE", "Write " + flag + " NAME=VALUE");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

template <class Unit, class Words>
std::optional<Unit> unitFrom(const std::string& text, const Words& words) {
  if (text.empty()) return std::nullopt;
  const auto found = std::find(words.begin(), words.end(), text);
  return static_cast<Unit>(found - words.begin());  // already checked by CLI11
}

MaintainInput inputFrom(const MaintainArguments& arguments) {
  warnOfForeignRunData(arguments.result);
  CalibrationOptions options;
  for (const std::string& setting : arguments.settings) {
    const auto [name, value] = splitAtEquals("--set", setting);
    setOption(options, name, value);
    if (!nameInTables(name).starts_with("maintain."))
      throw badInput("--set " + name, "has no effect: the command uses only options of the group maintain",
                     "Remove it; `evical options --all` lists the options of the group");
  }
  validate(options);
  const std::vector<std::filesystem::path> logs(arguments.logs.begin(), arguments.logs.end());
  MaintainInput input = readMaintainInput(logs, arguments.result);
  input.options = options.maintain;
  for (const std::string& imu : arguments.imus) input.settings.streams.insert(splitAtEquals("--imu", imu));
  input.settings.acceleration_unit =
      unitFrom<AccelerationUnit>(arguments.acceleration_unit, kAccelerationUnits);
  input.settings.angular_rate_unit =
      unitFrom<AngularRateUnit>(arguments.angular_rate_unit, kAngularRateUnits);
  input.trajectory = arguments.trajectory;
  return input;
}

int run(const MaintainArguments& arguments) {
  const MaintainInput input = inputFrom(arguments);
  return runAssessment(arguments, [&](const Console& console, const RunContext& context) {
    Maintenance maintenance = maintainImus(input, context);
    maintenance.version = kVersion;
    writeMaintenanceFiles(arguments.output, maintenance, console.logText());
    return maintenance;
  });
}

void addUnits(Command& command, MaintainArguments& arguments) {
  command
      .option("--acceleration-unit", arguments.acceleration_unit,
              "Unit of specific forces in logs that do not state it: m/s^2, g or -g")
      .oneOf(std::vector<std::string>(kAccelerationUnits.begin(), kAccelerationUnits.end()));
  command
      .option("--angular-rate-unit", arguments.angular_rate_unit,
              "Unit of angular rates in logs that do not state it: rad/s or deg/s")
      .oneOf(std::vector<std::string>(kAngularRateUnits.begin(), kAngularRateUnits.end()));
}

}  // namespace

void addMaintainCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<MaintainArguments>();
  Command command = app.command(
      "maintain",
      "Check IMUs over time from logs without a board: whether, when and by how much they have changed");
  command
      .option("LOG", arguments->logs,
              "Logs or recordings with IMU samples, in any format, of several IMUs or successive")
      .required();
  command.option("--result", arguments->result, "Folder of the old calibration, or its result.yaml")
      .required();
  addAssessmentArguments(command, *arguments, "Folder for maintenance.yaml and report.html", "group maintain")
      .required();
  command
      .option("--imu", arguments->imus,
              "NAME=STREAM: log or stream of an IMU of the old result. With two streams: NAME='GYROSCOPE + "
              "ACCELEROMETER'. Can be repeated")
      .repeated();
  command.option(
      "--trajectory", arguments->trajectory,
      "Poses of the reference IMU from another system: trajectory.csv of a calibration, or TUM's format");
  addUnits(command, *arguments);
  command.example("evical maintain log1.bag log2.bag --result result -o maintenance");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
