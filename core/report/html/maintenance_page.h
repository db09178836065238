// report.html of a maintenance: a page of its own, with the numbers behind its plots as CSV.
#pragma once

#include "core/data/maintenance.h"
#include "core/report/html/html_report.h"

#include <vector>

namespace evical {

std::vector<ReportFile> maintenanceReportFiles(const Maintenance& maintenance);

}  // namespace evical
