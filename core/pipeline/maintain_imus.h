// Whether IMUs are still as an old calibration says, and when they changed: one pass over their logs, however long.
#pragma once

#include "core/base/progress.h"
#include "core/data/maintenance.h"
#include "core/maintenance/maintenance_options.h"
#include "core/pipeline/imu_logs.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct MaintainInput {
  std::vector<std::filesystem::path> logs;
  NamedResult before;
  std::string before_name;  // as people know it
  ImuLogSettings settings;
  MaintenanceOptions options;
  std::filesystem::path trajectory;  // of the reference IMU; empty: none
};

// The old result: result.yaml or the folder of a run. Throws CalibrationError (BadInput).
MaintainInput readMaintainInput(const std::vector<std::filesystem::path>& logs,
                                const std::filesystem::path& result);

// A log that tells nothing is a verdict, no error. Throws CalibrationError (BadInput) and Cancelled.
Maintenance maintainImus(const MaintainInput& input, const RunContext& context);

}  // namespace evical
