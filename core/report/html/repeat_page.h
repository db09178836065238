// report.html of a repeat: a page of its own, with the numbers behind its plots as CSV.
#pragma once

#include "core/data/repeatability.h"
#include "core/report/html/html_report.h"

#include <vector>

namespace evical {

std::vector<ReportFile> repeatReportFiles(const Repeatability& repeat);

}  // namespace evical
