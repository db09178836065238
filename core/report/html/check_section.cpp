// Section of a check of an older calibration.
#include "core/report/assessment_report.h"
#include "core/report/html/assessment_section.h"
#include "core/report/html/html_text.h"

#include <fmt/format.h>

namespace evical::html {

void writeCheckVerdict(const ReportData& data, ReportPage& page) {
  if (data.check == nullptr) return;
  writeAssessmentVerdict(*data.check, fmt::format("Is the calibration {} still good?", data.check->before),
                         page);
}

void writeCheck(const ReportData& data, ReportPage& page) {
  if (data.check == nullptr) return;
  page.beginSection("check", "Is the old calibration still good?");
  writeFindings(*data.check, page);
  for (const CheckedWindows& windows : data.check->windows)
    page.text(paragraph("small", escaped(windowsText(windows)) + "."));
  writeTexts(data.check->notes, page);
  page.endSection();
}

}  // namespace evical::html
