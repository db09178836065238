#include "core/base/number.h"
#include "core/report/assessment_report.h"
#include "core/report/html/assessment_section.h"
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"
#include "core/report/result_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace evical {
namespace html {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::array<const char*, 6> kRecordingColours = {"c0", "c1", "c2", "o3", "o6", "o8"};

std::string differsText(const RepeatedRecording& recording) {
  std::string text;
  for (const Finding& finding : recording.findings)
    text += fmt::format("{}{} by {}", text.empty() ? "" : "; ", findingHtml(finding), changeHtml(finding));
  if (!recording.reason.empty())
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", statusName(recording.status),
                        escaped(recording.reason));
  return text;
}

void drawDistances(const Repeatability& repeat, ReportPage& page) {
  PlotTable table("plots/recordings.csv", {"chi_square", "limit", "degrees_of_freedom"});
  table.label_column = "recording";
  for (const RepeatedRecording& recording : repeat.recordings) {
    if (recording.freedom == 0) continue;
    table.labels.push_back(recording.name);
    table.add({recording.chi_square, recording.limit, static_cast<double>(recording.freedom)});
  }
  if (table.rows() == 0) return;
  PlotFrame frame;
  frame.title = "difference of each recording from the others";
  frame.y_label = "chi-square";
  frame.x_names = table.labels;
  frame.x = {0.0, static_cast<double>(table.rows())};
  frame.y = {0.0, 1.1 * std::max(*std::max_element(table.values[0].begin(), table.values[0].end()),
                                 *std::max_element(table.values[1].begin(), table.values[1].end()))};
  SvgPlot plot(frame);
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const auto x = static_cast<double>(k);
    const bool far = table.values[0][k] > table.values[1][k];
    plot.bar(x + 0.3, x + 0.7, 0.0, table.values[0][k], far ? "bad" : "c2");
    plot.segment(x + 0.1, table.values[1][k], x + 0.9, table.values[1][k], "ink");
    plot.segment(x + 0.1, table.values[2][k], x + 0.9, table.values[2][k], "muted");
  }
  page.figure(plot.svg(),
              "Each bar compares one recording with all others that fit; above the dark line it does not "
              "fit. The light line is the expected value for a rig within its allowed drift.",
              &table);
  page.keep(table);
}

void writeRecordings(const Repeatability& repeat, ReportPage& page) {
  page.beginSection("recordings", "Recordings");
  Rows rows;
  for (const RepeatedRecording& recording : repeat.recordings)
    rows.push_back({escaped(recording.name),
                    recording.outcome == RepeatOutcome::Fits
                        ? "fits"
                        : fmt::format("<b class=\"bad\">{}</b>", outcomeWords(recording.outcome)),
                    recording.freedom > 0 ? number(recording.chi_square, 1) : "",
                    recording.freedom > 0 ? number(recording.limit, 1) : "", differsText(recording)});
  page.text(table({"", "", "chi-square", "limit", "difference, or reason"}, rows));
  drawDistances(repeat, page);
  page.endSection();
}

// Rounded to the second digit of the variation between recordings.
std::string asVarying(double value, const RepeatedNumber& of) {
  double size = of.mean_sigma > 0.0 ? of.mean_sigma : of.deviation;
  if (of.joint_sigma > 0.0) size = std::min(size, of.joint_sigma);
  return html::number(value, decimalsFor(size, 6, 6));
}

void writeStatistics(const Repeatability& repeat, ReportPage& page) {
  page.beginSection("numbers", "Numbers");
  Rows rows;
  for (const RepeatedQuantity& quantity : repeat.quantities)
    for (const RepeatedNumber& each : quantity.numbers)
      rows.push_back({escaped(quantity.sensor + "." + each.name), asVarying(each.mean, each),
                      asVarying(each.deviation, each), asVarying(each.mean_sigma, each),
                      each.count > 1 ? number(each.ratio(), 2) : "",
                      quantity.common ? withSigma(each.joint, each.joint_sigma) : "separate",
                      escaped(each.unit)});
  page.text(table({"", "mean", "standard deviation", "mean sigma", "ratio", "joint solution", "unit"}, rows));
  page.text(paragraph(
      "small",
      fmt::format(
          "The standard deviation is over the recordings that fit. The mean sigma is that of single "
          "recordings, without the share of priors that all have in common. With realistic sigmas the ratio "
          "of both is about 1; with few recordings it varies widely. Over all numbers it is {}.",
          number(repeat.rms_ratio, 2))));
  page.endSection();
}

// Numbers of one unit in one plot.
struct Panel {
  const RepeatedQuantity* quantity;
  std::vector<const RepeatedNumber*> numbers;
};

std::vector<Panel> panelsOf(const RepeatedQuantity& quantity) {
  std::vector<Panel> panels;
  for (const RepeatedNumber& each : quantity.numbers) {
    const auto same = [&](const Panel& panel) { return panel.numbers.front()->unit == each.unit; };
    auto panel = std::find_if(panels.begin(), panels.end(), same);
    if (panel == panels.end()) panel = panels.insert(panels.end(), Panel{&quantity, {}});
    panel->numbers.push_back(&each);
  }
  return panels;
}

double middleOf(const RepeatedQuantity& quantity, const RepeatedNumber& number) {
  return quantity.common && number.joint_sigma > 0.0 ? number.joint : number.mean;
}

PlotTable repeatTable(const Panel& panel, const std::vector<std::string>& columns, const std::string& file) {
  std::vector<std::string> names;
  for (const RepeatedNumber* each : panel.numbers) {
    names.push_back(each->name);
    names.push_back(each->name + "_std");
  }
  PlotTable table(file, names);
  table.label_column = "recording";
  for (std::size_t k = 0; k < columns.size(); ++k) {
    std::vector<double> row;
    for (const RepeatedNumber* each : panel.numbers) {
      row.push_back(each->values[k] - middleOf(*panel.quantity, *each));
      row.push_back(each->sigmas[k]);
    }
    table.labels.push_back(columns[k]);
    table.add(row);
  }
  return table;
}

void drawPanel(const Panel& panel, const std::vector<std::string>& columns, const std::string& file,
               ReportPage& page) {
  const PlotTable table = repeatTable(panel, columns, file);
  PlotFrame frame;
  frame.title = fmt::format("{} of {}", panel.quantity->title, panel.quantity->sensor);
  frame.y_label = panel.numbers.front()->unit.empty() ? "1" : panel.numbers.front()->unit;
  frame.x_names = columns;
  frame.x = {0.0, static_cast<double>(columns.size())};
  double largest = 0.0;
  for (std::size_t n = 0; n < panel.numbers.size(); ++n)
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double reach = std::abs(table.values[2 * n][k]) + table.values[2 * n + 1][k];
      if (std::isfinite(reach)) largest = std::max(largest, reach);
    }
  frame.y = {-1.1 * largest, 1.1 * largest};
  SvgPlot plot(frame);
  plot.segment(frame.x.low, 0.0, frame.x.high, 0.0, "muted");
  std::vector<LegendEntry> legend;
  const auto count = static_cast<double>(panel.numbers.size());
  for (std::size_t n = 0; n < panel.numbers.size(); ++n) {
    const std::string colour = kRecordingColours[n % kRecordingColours.size()];
    legend.push_back({colour, panel.numbers[n]->name});
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double x = static_cast<double>(k) + 0.2 + 0.6 * (static_cast<double>(n) + 0.5) / count;
      const double y = table.values[2 * n][k], sigma = table.values[2 * n + 1][k];
      plot.segment(x, y - sigma, x, y + sigma, colour);
      plot.points(std::vector{x}, std::vector{y}, colour, 6.0);
    }
  }
  plot.legend(legend);
  page.figure(plot.svg(),
              panel.quantity->common
                  ? "Each recording alone minus the joint solution; bars are one standard deviation."
                  : "Each recording alone minus the mean; bars are one standard deviation.",
              &table);
  page.keep(table);
}

void writePictures(const Repeatability& repeat, ReportPage& page) {
  if (repeat.columns.size() < 2) return;
  page.beginSection("spread", "Comparison of the recordings");
  int picture = 0;
  for (const RepeatedQuantity& quantity : repeat.quantities)
    for (const Panel& panel : panelsOf(quantity))
      drawPanel(panel, repeat.columns, fmt::format("plots/quantity{}.csv", ++picture), page);
  page.endSection();
}

}  // namespace
}  // namespace html

std::vector<ReportFile> reportFiles(const Repeatability& repeat) {
  html::ReportPage verdict, page;
  const std::size_t count = repeat.recordings.size();
  html::writeAssessmentVerdict(repeat, fmt::format("Do {} recordings give the same calibration?", count),
                               verdict);
  html::writeRecordings(repeat, page);
  if (!repeat.quantities.empty()) html::writeStatistics(repeat, page);
  html::writePictures(repeat, page);
  if (!repeat.notes.empty()) {
    page.beginSection("notes", "Notes");
    html::writeTexts(repeat.notes, page);
    page.endSection();
  }
  return html::filesOf({fmt::format("Repeat of {} recordings", count), repeat.version, {}}, verdict, page);
}

}  // namespace evical
