#include "core/report/html/html_report.h"

#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/report_style.h"

#include <fmt/format.h>

namespace evical {
namespace {

using html::escaped;

std::string startText(const NamedResult& named) {
  if (!named.result->start_ns) return "";
  return fmt::format(", begins at {}.{:09} s", *named.result->start_ns / 1'000'000'000,
                     std::abs(*named.result->start_ns % 1'000'000'000));
}

std::string wholePage(const ReportData& data, const html::ReportPage& verdict, const html::ReportPage& page) {
  const std::string title = (data.check == nullptr ? "Calibration of " : "Check of a calibration by ") +
                            escaped(data.recording.empty() ? "a recording" : data.recording);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
      "charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"generator\" content=\"evical {0}\"/>\n<title>{1}</title>\n<style>\n{2}</style>\n</head>\n"
      "<body>\n<main>\n<header><h1>{1}</h1><p "
      "class=\"small\">{3}{4}</p></header>\n{5}<nav>{6}</nav>\n{7}</main>\n"
      "</body>\n</html>\n",
      escaped(data.named.version), title, html::kReportStyle, "evical " + escaped(data.named.version),
      startText(data.named), verdict.body(), page.contents(), page.body());
}

}  // namespace

std::vector<ReportFile> reportFiles(const ReportData& data) {
  const html::Measures measures = html::measure(data);
  html::ReportPage verdict, page;
  html::writeCheckVerdict(data, verdict);
  if (data.check == nullptr) html::writeVerdict(data, measures, verdict);
  html::writeCheck(data, page);
  html::writeAdvice(data, measures, page);
  html::writeNumbers(data, page);
  html::writeSensors(data, page);
  html::writeIntrinsicsSection(data, page);
  html::writeDetections(data, measures, page);
  html::writeCoverage(data, measures, page);
  html::writeExcitation(data, measures, page);
  html::writeReprojection(data, measures, page);
  html::writeInertial(data, measures, page);
  html::writeBiases(data, page);
  html::writeConvergence(data, page);
  html::writeUncertainty(data, page);
  html::writeCrossValidation(data, page);
  html::writeRun(data, page);
  std::vector<ReportFile> files = {{"report.html", wholePage(data, verdict, page)}};
  for (const html::PlotTable& table : page.tables()) files.push_back({table.file, html::tableCsv(table)});
  return files;
}

}  // namespace evical
