// Page under construction: its sections, and the tables of its plots.
#pragma once

#include "core/report/html/html_report.h"
#include "core/report/html/measures.h"
#include "core/report/html/plot_table.h"

#include <string>
#include <string_view>
#include <vector>

namespace evical::html {

class ReportPage {
 public:
  // `id` is the section's anchor.
  void beginSection(std::string_view id, std::string_view title);
  void endSection() { body_ += "</section>\n"; }

  void heading(std::string_view text);                 // a sensor's name: escaped here
  void text(std::string_view html) { body_ += html; }  // HTML already
  // The caption explains what to look for; it names the CSV file if there is a table.
  void figure(const std::string& svg, std::string_view caption, const PlotTable* table = nullptr);
  void beginRow() { body_ += "<div class=\"row\">\n"; }  // figures side by side if there is room
  void endRow() { body_ += "</div>\n"; }
  void keep(PlotTable table) { tables_.push_back(std::move(table)); }

  const std::string& body() const { return body_; }
  const std::string& contents() const { return contents_; }  // links to the sections
  const std::vector<PlotTable>& tables() const { return tables_; }

 private:
  std::string body_, contents_;
  std::vector<PlotTable> tables_;
};

// Header of a page.
struct PageHead {
  std::string title, version, remark;  // the remark follows the version
};
// The whole file: verdict, links to sections, sections.
std::string document(const PageHead& head, const ReportPage& verdict, const ReportPage& page);

std::string cameraName(const ReportData& data, std::size_t index);
std::string imuName(const ReportData& data, std::size_t index);

// The sections, in the page's order. A section without content is omitted.
void writeVerdict(const ReportData& data, const Measures& measures, ReportPage& page);
void writeCheckVerdict(const ReportData& data, ReportPage& page);
void writeCheck(const ReportData& data, ReportPage& page);
void writeAdvice(const ReportData& data, const Measures& measures, ReportPage& page);
void writeNumbers(const ReportData& data, ReportPage& page);
void writeSensors(const ReportData& data, ReportPage& page);
void writeIntrinsicsSection(const ReportData& data, ReportPage& page);
void writeDetections(const ReportData& data, const Measures& measures, ReportPage& page);
void writeCoverage(const ReportData& data, const Measures& measures, ReportPage& page);
void writeExcitation(const ReportData& data, const Measures& measures, ReportPage& page);
void writeReprojection(const ReportData& data, const Measures& measures, ReportPage& page);
void writeInertial(const ReportData& data, const Measures& measures, ReportPage& page);
void writeBiases(const ReportData& data, ReportPage& page);
void writeConvergence(const ReportData& data, ReportPage& page);
void writeUncertainty(const ReportData& data, ReportPage& page);
void writeSplitHalfCheck(const ReportData& data, ReportPage& page);
void writeRun(const ReportData& data, ReportPage& page);

}  // namespace evical::html
