// Page under construction: its sections, and the tables of its plots.
#pragma once

#include "core/report/html/html_report.h"
#include "core/report/html/measures.h"
#include "core/report/html/svg_plot.h"

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

// Style sheet: light and dark as the reader's system prefers, narrow screens, paper.

namespace evical::html {

inline constexpr const char* kReportStyle = R"css(
:root { --paper: #ffffff; --panel: #f5f6f8; --ink: #1c2330; --muted: #667085; --rule: #d9dde4; --grid: #e8ebf0;
  --c0: #c8402f; --c1: #1f8a5b; --c2: #2f66c8; --ok: #1f8a5b; --doubtful: #b07300; --failed: #c8402f;
  --o1: #8cc9a8; --o2: #b9bfca; --o3: #e0b354; --o4: #d98a4e; --o5: #cf6a6a; --o6: #9a7bc8; --o7: #6b7f99;
  --o8: #5fa3b8; --o9: #a88b6a; --o10: #8a8f98; --o11: #c27ba0; --o12: #b5a642; }
@media (prefers-color-scheme: dark) { :root { --paper: #14181f; --panel: #1c222c; --ink: #e6eaf1; --muted: #98a2b3;
  --rule: #323a47; --grid: #262d38; --c0: #ff8172; --c1: #4fcf96; --c2: #7fabff; --ok: #4fcf96; --doubtful: #e8b04a;
  --failed: #ff8172; --o1: #3f8a68; --o2: #4a5361; --o3: #b98d35; --o4: #b56c36; --o5: #b35050; --o6: #7a5fa8;
  --o7: #5a6d87; --o8: #3f8094; --o9: #86694a; --o10: #6b7078; --o11: #a05c80; --o12: #8a7d20; } }
@media print { :root { --paper: #fff; --panel: #fff; --ink: #000; --muted: #444; --rule: #bbb; --grid: #ddd;
  --c0: #c8402f; --c1: #1f8a5b; --c2: #2f66c8; --ok: #1f8a5b; --doubtful: #b07300; --failed: #c8402f;
  --o1: #8cc9a8; --o2: #b9bfca; --o3: #e0b354; --o4: #d98a4e; --o5: #cf6a6a; --o6: #9a7bc8; --o7: #6b7f99;
  --o8: #5fa3b8; --o9: #a88b6a; --o10: #8a8f98; --o11: #c27ba0; --o12: #b5a642; }
  nav { display: none; } figure, tr, .tile, .verdict { break-inside: avoid; } h2, h3 { break-after: avoid; } }
* { box-sizing: border-box; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
html { color-scheme: light dark; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 960px; margin: 0 auto; padding: 20px 24px 60px; }
h1 { font-size: 1.5rem; margin: 0; overflow-wrap: anywhere; } h2 { font-size: 1.2rem; margin: 2.4rem 0 .6rem; padding-top: .8rem; border-top: 1px solid var(--rule); }
h3 { font-size: 1rem; margin: 1.2rem 0 .4rem; } p { margin: .4rem 0; }
.title { font-size: .9rem; font-weight: 600; margin: .2rem 0; } .small, small, figcaption { color: var(--muted); font-size: .85rem; } .pm { color: var(--muted); white-space: nowrap; }
.verdict { display: flex; gap: 16px; align-items: flex-start; margin: 14px 0; padding: 12px 16px; background: var(--panel); border-left: 6px solid var(--ok); border-radius: 4px; }
.verdict b { font-size: 1.15rem; color: var(--ok); } .verdict p:first-child { margin-top: 2px; } .verdict .reason { font-weight: 600; }
.verdict.doubtful { border-color: var(--doubtful); } .verdict.doubtful b { color: var(--doubtful); }
.verdict.failed { border-color: var(--failed); } .verdict.failed b { color: var(--failed); }
.verdict p { overflow-wrap: anywhere; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 10px; }
.tile { background: var(--panel); border-radius: 4px; padding: 8px 12px; overflow-wrap: anywhere; } .tile span, .tile small { display: block; color: var(--muted); font-size: .8rem; }
.tile b { font-size: 1.05rem; } .tile .pm { display: inline; font-size: 1em; }
nav { margin: 16px 0 0; line-height: 2; } nav a { margin-right: 14px; } a { color: var(--c2); text-decoration: none; } a:hover { text-decoration: underline; }
.wide { overflow-x: auto; max-width: 100%; } table { font-size: .92rem; border-collapse: collapse; margin: .5rem 0; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 3px 16px 3px 0; border-bottom: 1px solid var(--rule); vertical-align: top; } th { color: var(--muted); font-weight: 500; font-size: .85rem; }
code { font-size: .9em; } li { margin: .3rem 0; } li small { display: block; } summary { cursor: pointer; color: var(--muted); }
figure { margin: .8rem 0; min-width: 0; } .row { display: flex; flex-wrap: wrap; gap: 0 24px; } .row > figure { flex: 1 1 280px; max-width: 460px; }
figcaption { max-width: 760px; } .csv { white-space: nowrap; font-size: .95em; }
svg { display: block; max-width: 100%; height: auto; } svg text { font-size: 12px; fill: var(--ink); }
.grid { stroke: var(--grid); fill: none; } .frame { fill: none; stroke: var(--rule); }
.line { fill: none; stroke: currentColor; stroke-width: 1.4; stroke-linejoin: round; } .thick { stroke-width: 2.2; } .dashed { stroke-dasharray: 5 4; color: var(--muted); }
.dots { fill: none; stroke: currentColor; stroke-linecap: round; } .faint { opacity: .45; } .fill { fill: currentColor; stroke: none; }
.key { display: inline-block; width: 12px; height: 10px; margin-right: 7px; background: currentColor; }
.c0, .warm, .bad { color: var(--c0); } .c1 { color: var(--c1); } .c2, .cold { color: var(--c2); } .ink { color: var(--ink); } .muted { color: var(--muted); }
.o0 { color: var(--ok); } .o1 { color: var(--o1); } .o2 { color: var(--o2); } .o3 { color: var(--o3); } .o4 { color: var(--o4); } .o5 { color: var(--o5); } .o6 { color: var(--o6); } .o7 { color: var(--o7); } .o8 { color: var(--o8); } .o9 { color: var(--o9); } .o10 { color: var(--o10); } .o11 { color: var(--o11); } .o12 { color: var(--o12); }
@media (max-width: 640px) { main { padding: 12px 14px 40px; } .wide > svg { min-width: 560px; } .row .wide > svg { min-width: 0; } .verdict { flex-direction: column; gap: 4px; } th, td { padding-right: 12px; } }
)css";

}  // namespace evical::html
