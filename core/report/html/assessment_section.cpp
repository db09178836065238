#include "core/report/html/assessment_section.h"

#include "core/report/html/html_text.h"

#include "core/report/assessment_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// Section of a check of an older calibration.

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

namespace evical::html {
namespace {

using Rows = std::vector<std::vector<std::string>>;

const char* cssClass(Verdict verdict) {
  static constexpr std::array<const char*, 3> kClasses = {"ok", "failed", "doubtful"};
  return kClasses.at(static_cast<std::size_t>(verdict));
}

std::string sized(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "&ndash;";
  return shownUnit(unit).empty() ? significant(value, 2) : significant(value, 2) + " " + escaped(unit);
}

std::string verdictHtml(const Finding& finding) {
  return finding.changed ? "<b class=\"bad\">changed</b>" : verdictWords(finding.verdict());
}

std::string valueHtml(const ValueWithSigma& number) {
  return number.isKnown() ? withSigma(number.value, number.sigma) : "";
}

// Table without the columns that are empty in all rows.
std::string tableOf(std::vector<std::string> header, Rows rows) {
  for (std::size_t column = header.size(); column-- > 1;) {
    if (std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return !row[column].empty(); }))
      continue;
    const auto at = static_cast<std::ptrdiff_t>(column);
    header.erase(header.begin() + at);
    for (std::vector<std::string>& row : rows) row.erase(row.begin() + at);
  }
  return table(header, rows);
}

}  // namespace

void writeAssessmentVerdict(const Assessment& assessment, const std::string& question, ReportPage& page) {
  std::string advice;
  for (const std::string& text : assessment.advice)
    advice += paragraph("", escaped(text) + (text.ends_with('.') ? "" : "."));
  page.text(fmt::format("<div class=\"verdict {}\"><b>{}</b><div><p>{}</p>{}{}</div></div>\n",
                        cssClass(assessment.verdict), verdictWords(assessment.verdict), escaped(question),
                        paragraph("reason", escaped(assessment.reason) + "."), advice));
}

std::string changeHtml(const Finding& finding) {
  const std::string unit = shownUnit(finding.unit);
  return withSigma(finding.change, finding.change_sigma) + (unit.empty() ? "" : " " + escaped(unit));
}

std::string findingHtml(const Finding& finding) {
  return fmt::format("{} of {}", escaped(finding.title), escaped(ofSensor(finding.sensor, finding.against)));
}

void writeFindings(const Assessment& assessment, ReportPage& page) {
  if (assessment.findings.empty()) return;
  Rows rows, numbers;
  for (const Finding& finding : assessment.findings) {
    rows.push_back(
        {findingHtml(finding), finding.source == FindingSource::Recording ? "" : sourceWords(finding.source),
         changeHtml(finding), number(finding.sigmas, 1),
         finding.edge_px > 0.0 ? sized(finding.edge_px, "px") : "",
         sized(finding.smallest_detectable_change, finding.unit),
         finding.required_detectability > 0.0 ? sized(finding.required_detectability, finding.unit) : "",
         verdictHtml(finding)});
    for (const ComparedNumber& each : finding.numbers)
      numbers.push_back({escaped(ofSensor(finding.sensor, finding.against)), escaped(each.name),
                         valueHtml(each.before), valueHtml(each.now), valueHtml(each.joint),
                         escaped(shownUnit(each.unit))});
  }
  page.text(tableOf(
      {"", "from", "change", "in sigmas", "at the image's edge", "detectable", "required", "verdict"}, rows));
  page.text(paragraph("small",
                      fmt::format("<i>Change</i> assumes that only this quantity has changed; for a lens it "
                                  "is the RMS over the image. A change of the <i>detectable</i> size is "
                                  "found with a probability of 95 %, in any direction; the verdict needs the "
                                  "<i>required</i> size. The probability of a false alarm is at most {} %.",
                                  plain(100.0 * assessment.false_alarms))));
  page.text("<details><summary>Numbers</summary>" +
            tableOf({"", "", "before", "now, alone", "both together", "unit"}, numbers) + "</details>\n");
}

void writeTexts(const std::vector<std::string>& texts, ReportPage& page) {
  std::string items;
  for (const std::string& text : texts) items += element("li", "", escaped(text));
  if (!items.empty()) page.text("<ul>" + items + "</ul>\n");
}

std::vector<ReportFile> filesOf(const PageHead& head, const ReportPage& verdict, const ReportPage& page) {
  std::vector<ReportFile> files = {{"report.html", document(head, verdict, page)}};
  for (const PlotTable& table : page.tables()) files.push_back({table.file, tableCsv(table)});
  return files;
}

}  // namespace evical::html
