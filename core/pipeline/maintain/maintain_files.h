// What a maintenance leaves in its folder: maintenance.yaml, stops.csv, a CSV for each pair of IMUs, report.html with
// its tables, log.txt. All appear together, or none.
#pragma once

#include "core/data/maintenance.h"

#include <filesystem>
#include <string>

namespace evical {

void writeMaintenanceFiles(const std::filesystem::path& folder, const Maintenance& maintenance,
                           const std::string& log);

}  // namespace evical
