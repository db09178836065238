// Files of a maintenance: maintenance.yaml, stops.csv, a CSV file for each pair of IMUs, report.html with its
// tables, log.txt. They are written together or not at all.
#pragma once

#include "core/data/assessment.h"

#include <filesystem>
#include <string>

namespace evical {

void writeMaintenanceFiles(const std::filesystem::path& folder, const Maintenance& maintenance,
                           const std::string& log);

}  // namespace evical
