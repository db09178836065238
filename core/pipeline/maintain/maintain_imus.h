// Whether IMUs are still as an old calibration says, and when they changed: one pass over their logs, however long.
#pragma once

#include "core/base/progress.h"
#include "core/base/shared_options.h"
#include "core/data/maintenance.h"
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
  std::string before_name;  // as people know it
  ImuLogSettings settings;
  ImuReadings readings;  // of the calibration
  SharedOptions<MaintenanceOptions> options;
  std::filesystem::path trajectory;  // of the reference IMU; empty: none

  MaintainInput();
};

// The old result: result.yaml or the folder of a run. Throws CalibrationError (BadInput).
MaintainInput readMaintainInput(const std::vector<std::filesystem::path>& logs,
                                const std::filesystem::path& result);

// Its stages, as progress names them and as people read them, with their shares of the time.
struct MaintainStage {
  const char *name, *title;
  double share;
};
inline constexpr std::array kMaintainStages = {
    MaintainStage{"look", "Look at the logs", 0.1}, MaintainStage{"read", "Read the logs", 0.75},
    MaintainStage{"trajectory", "Compare with the trajectory", 0.1},
    MaintainStage{"follow", "Follow the IMUs", 0.05}};

// A log that tells nothing is a verdict, no error. Throws CalibrationError (BadInput) and Cancelled.
Maintenance maintainImus(const MaintainInput& input, const RunContext& context);

}  // namespace evical
