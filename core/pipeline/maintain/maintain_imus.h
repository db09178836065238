// Check of IMUs against an old calibration, with times of changes, in one pass over logs of any length.
#pragma once

#include "core/base/option_table.h"
#include "core/base/progress.h"
#include "core/data/assessment.h"
#include "core/pipeline/maintain/imu_logs.h"
#include "core/report/result_yaml.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct MaintenanceOptions;

struct MaintainInput {
  std::vector<std::filesystem::path> logs;
  NamedResult before;
  std::string before_name;  // displayed name
  ImuLogSettings settings;
  ImuReadings readings;  // of the calibration
  SharedOptions<MaintenanceOptions> options;
  std::filesystem::path trajectory;  // of the reference IMU; empty: none

  MaintainInput();
};

// The old result: result.yaml or the folder of a run. Throws CalibrationError (BadInput).
MaintainInput readMaintainInput(const std::vector<std::filesystem::path>& logs,
                                const std::filesystem::path& result);

// Stages: name in progress, displayed name, share of the time.
struct MaintainStage {
  const char *name, *title;
  double share;
};
inline constexpr std::array kMaintainStages = {
    MaintainStage{"look", "Inspect the logs", 0.1}, MaintainStage{"read", "Read the logs", 0.75},
    MaintainStage{"trajectory", "Compare with the trajectory", 0.1},
    MaintainStage{"follow", "Track the IMUs", 0.05}};

// An uninformative log gives a verdict, not an error. Throws CalibrationError (BadInput) and Cancelled.
Maintenance maintainImus(const MaintainInput& input, const RunContext& context);

}  // namespace evical
