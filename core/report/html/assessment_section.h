// Common parts of the pages of a check, a maintenance and a repeat.
#pragma once

#include "core/data/assessment.h"
#include "core/report/html/html_report.h"
#include "core/report/html/report_page.h"

#include <string>
#include <vector>

namespace evical::html {

// Head of the page: question, verdict, reason, advice.
void writeAssessmentVerdict(const Assessment& assessment, const std::string& question, ReportPage& page);

// Each quantity's change, and the numbers behind it.
void writeFindings(const Assessment& assessment, ReportPage& page);

// "rotation of left by 0.5 ± 0.1 deg": HTML.
std::string findingHtml(const Finding& finding);
std::string changeHtml(const Finding& finding);

// A list of texts, which are escaped here; nothing if there are none.
void writeTexts(const std::vector<std::string>& texts, ReportPage& page);

// The page, and the tables of its plots.
std::vector<ReportFile> filesOf(const PageHead& head, const ReportPage& verdict, const ReportPage& page);

}  // namespace evical::html
