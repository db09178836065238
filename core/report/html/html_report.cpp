#include "core/report/html/html_report.h"

#include "core/report/html/assessment_section.h"
#include "core/report/html/report_page.h"

#include <fmt/format.h>

namespace evical {
namespace {

std::string startText(const NamedResult& named) {
  if (!named.result->start_ns) return "";
  return fmt::format(", begins at {}.{:09} s", *named.result->start_ns / 1'000'000'000,
                     std::abs(*named.result->start_ns % 1'000'000'000));
}

std::string titleOf(const ReportData& data) {
  return (data.check == nullptr ? "Calibration of " : "Check of a calibration by ") +
         (data.recording.empty() ? "a recording" : data.recording);
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
  html::writeSplitHalfCheck(data, page);
  html::writeRun(data, page);
  return html::filesOf({titleOf(data), data.named.version, startText(data.named)}, verdict, page);
}

}  // namespace evical
