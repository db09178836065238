#include "core/report/html/maintenance_page.h"

#include "core/report/html/html_text.h"
#include "core/report/html/plot_table.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"
#include "core/report/maintenance_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace evical {
namespace html {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::array<const char*, 3> kPartColours = {"c0", "c1", "c2"};
constexpr std::size_t kMostPoints = 2000;  // of a plot; maintenance's own CSV has all

const char* maintenanceClass(MaintenanceVerdict verdict) {
  switch (verdict) {
    case MaintenanceVerdict::Unchanged:
      return "ok";
    case MaintenanceVerdict::Changed:
      return "failed";
    case MaintenanceVerdict::CannotTell:
      break;
  }
  return "doubtful";
}

std::string ofSensorText(const std::string& sensor, const std::string& against) {
  return escaped(against.empty() ? sensor : sensor + " against " + against);
}

std::string unitText(const std::string& unit) {
  return unit == "1" ? "" : escaped(unit);
}

void writeVerdictOf(const Maintenance& maintenance, ReportPage& page) {
  std::string advice;
  for (const std::string& text : maintenance.advice) advice += paragraph("", escaped(text) + ".");
  page.text(fmt::format("<div class=\"verdict {}\"><b>{}</b><div><p>{}</p>{}{}</div></div>\n",
                        maintenanceClass(maintenance.verdict), verdictWords(maintenance.verdict),
                        "Are the IMUs still as they were calibrated?",
                        paragraph("reason", escaped(maintenance.reason) + "."), advice));
}

std::string outcomeText(const MaintainedQuantity& quantity) {
  if (quantity.changed) return "<b class=\"bad\">changed</b>";
  return quantity.told() ? "unchanged" : "cannot tell";
}

void writeQuantities(const Maintenance& maintenance, ReportPage& page) {
  if (maintenance.quantities.empty()) return;
  page.beginSection("quantities", "Since the calibration");
  Rows rows, numbers;
  for (const MaintainedQuantity& quantity : maintenance.quantities) {
    rows.push_back(
        {ofSensorText(quantity.sensor, quantity.against), escaped(quantity.title),
         sourceName(quantity.source) == std::string("other_imu") ? "other IMU" : sourceName(quantity.source),
         withSigma(quantity.change, quantity.change_sigma),
         std::isfinite(quantity.would_notice) ? significant(quantity.would_notice) : "&ndash;",
         unitText(quantity.unit), outcomeText(quantity)});
    for (const MaintainedNumber& each : quantity.numbers)
      numbers.push_back({ofSensorText(quantity.sensor, quantity.against), escaped(each.name),
                         withSigma(each.before, each.before_sigma), withSigma(each.now, each.now_sigma),
                         unitText(each.unit)});
  }
  page.text(table({"", "", "from", "change", "would show", "unit", ""}, rows));
  page.text(paragraph(
      "small", fmt::format("A change that is as large as <i>would show</i> is found with 95 % or more, in "
                           "whichever direction. In all tests together a log in which nothing has changed "
                           "has an alarm with {} % at most.",
                           plain(100.0 * maintenance.false_alarms))));
  page.text("<details><summary>Numbers</summary>" + table({"", "", "before", "now", "unit"}, numbers) +
            "</details>\n");
  page.endSection();
}

void writeSteps(const Maintenance& maintenance, ReportPage& page) {
  if (maintenance.steps.empty()) return;
  page.beginSection("steps", "Changes on the way");
  Rows rows;
  for (const MaintenanceStep& step : maintenance.steps) {
    std::string others;
    for (const std::string& other : step.or_else) others += (others.empty() ? "" : ", ") + escaped(other);
    rows.push_back({number(step.at_s, 1), number(step.noticed_s, 1), ofSensorText(step.sensor, step.against),
                    escaped(step.title), withSigma(step.size, step.size_sigma), unitText(step.unit), others});
  }
  page.text(table({"at, s", "noticed at, s", "", "what", "by", "unit", "or else"}, rows));
  page.endSection();
}

// Numbers of one unit beside each other, with a band of one sigma as faint lines.
void drawPart(const MaintenanceTrack& track, const TrackPart& part, const std::string& file,
              const Maintenance& maintenance, ReportPage& page) {
  const std::size_t first = part.first, count = part.parts.size();
  std::vector<std::string> names = {"time_s"};
  for (std::size_t c = first; c < first + count; ++c) {
    names.push_back(track.columns[c]);
    names.push_back("std of " + track.columns[c]);
  }
  PlotTable plotted(file, names);
  const std::size_t stride = strideFor(track.times_s.size(), kMostPoints);
  for (std::size_t k = 0; k < track.times_s.size(); k += stride) {
    std::vector<double> row = {track.times_s[k]};
    for (std::size_t c = first; c < first + count; ++c) {
      row.push_back(track.values[c][k]);
      row.push_back(track.sigmas[c][k]);
    }
    plotted.add(row);
  }
  if (plotted.rows() < 2) return;
  // The first moments, of which hardly anything is known, would squeeze all others.
  const std::size_t skipped = std::min<std::size_t>(plotted.rows() / 10, 10);
  PlotFrame frame;
  frame.title =
      fmt::format("{} of {}", part.name,
                  track.against.empty() ? track.sensor : track.sensor + " against " + track.against);
  frame.x_label = "s";
  frame.y_label = part.unit;
  frame.x = rangeOf(plotted.values[0]);
  frame.y = rangeOf(std::span(plotted.values[1]).subspan(skipped));
  for (std::size_t c = 1; c < count; ++c)
    frame.y = joined(frame.y, rangeOf(std::span(plotted.values[1 + 2 * c]).subspan(skipped)));
  SvgPlot plot(frame);
  plot.segment(frame.x.low, 0.0, frame.x.high, 0.0, "muted");
  for (const MaintenanceStep& step : maintenance.steps)
    if (isIn(step, track)) plot.segment(step.at_s, frame.y.low, step.at_s, frame.y.high, "ink");
  std::vector<LegendEntry> legend;
  for (std::size_t c = 0; c < count; ++c) {
    const char* const colour = kPartColours[c % kPartColours.size()];
    const std::vector<double>&values = plotted.values[1 + 2 * c], &sigmas = plotted.values[2 + 2 * c];
    std::vector<double> low, high;
    for (std::size_t k = 0; k < values.size(); ++k) {
      low.push_back(values[k] - sigmas[k]);
      high.push_back(values[k] + sigmas[k]);
    }
    plot.line(plotted.values[0], values, colour);
    plot.line(plotted.values[0], low, fmt::format("{} faint", colour));
    plot.line(plotted.values[0], high, fmt::format("{} faint", colour));
    const std::string& column = track.columns[first + c];
    legend.push_back({colour, column.substr(0, column.find(' '))});
  }
  plot.legend(legend);
  page.figure(plot.svg(),
              "Difference from the old calibration, as known at each moment; faint lines are one standard "
              "deviation to either side, a dark line is a change that was noticed.",
              &plotted);
  page.keep(plotted);
}

void writeTracks(const Maintenance& maintenance, ReportPage& page) {
  if (maintenance.tracks.empty()) return;
  page.beginSection("tracks", "Over time");
  int picture = 0;
  for (const MaintenanceTrack& track : maintenance.tracks)
    for (const TrackPart& part : partsOf(track))
      drawPart(track, part, fmt::format("plots/track{}.csv", ++picture), maintenance, page);
  page.endSection();
}

void drawStops(const MaintainedImu& imu, const std::string& file, ReportPage& page) {
  PlotTable plotted(file, {"time_s", "residual_m_s2", "sigma_m_s2", "used"});
  for (const MaintainedStop& stop : imu.stops)
    plotted.add(
        {0.5 * (stop.from_s + stop.to_s), stop.residual_m_s2, stop.sigma_m_s2, stop.used ? 1.0 : 0.0});
  PlotFrame frame;
  frame.title = fmt::format("What stops leave of gravity's norm, {}", imu.name);
  frame.x_label = "s";
  frame.y_label = "m/s^2";
  frame.x = rangeOf(std::array{imu.from_s, imu.to_s});
  double largest = 0.0;
  for (const MaintainedStop& stop : imu.stops)
    largest = std::max(largest, std::abs(stop.residual_m_s2) + stop.sigma_m_s2);
  frame.y = {-1.1 * largest, 1.1 * largest};
  SvgPlot plot(frame);
  plot.segment(frame.x.low, 0.0, frame.x.high, 0.0, "muted");
  for (std::size_t k = 0; k < plotted.rows(); ++k) {
    const double x = plotted.values[0][k], y = plotted.values[1][k], sigma = plotted.values[2][k];
    const char* const colour = plotted.values[3][k] > 0.0 ? "c2" : "bad";
    plot.segment(x, y - sigma, x, y + sigma, colour);
    plot.points(std::vector{x}, std::vector{y}, colour, 6.0);
  }
  page.figure(plot.svg(),
              "With the numbers of now each stop's specific force is gravity to within its bar, one standard "
              "deviation. Red ones contradict the others and are left out.",
              &plotted);
  page.keep(plotted);
}

void writeStops(const Maintenance& maintenance, ReportPage& page) {
  const auto hasStops = [](const MaintainedImu& imu) { return !imu.stops.empty(); };
  if (std::none_of(maintenance.imus.begin(), maintenance.imus.end(), hasStops)) return;
  page.beginSection("stops", "Stops");
  int picture = 0;
  for (const MaintainedImu& imu : maintenance.imus) {
    ++picture;
    if (imu.stops.empty()) continue;
    page.heading(imu.name);
    page.text(paragraph(
        "", fmt::format("{} stops. Least known from them: {}.", imu.stops.size(), escaped(imu.weakest))));
    drawStops(imu, fmt::format("plots/stops{}.csv", picture), page);
  }
  page.endSection();
}

void writeNotesOf(const Maintenance& maintenance, ReportPage& page) {
  page.beginSection("run", "To know");
  std::string items;
  for (const std::string& text : maintenance.notes) items += element("li", "", escaped(text));
  for (const MaintainedImu& imu : maintenance.imus)
    items += element("li", "",
                     escaped(fmt::format("{}: stream {}, {:.1f} Hz, from {:.1f} s to {:.1f} s", imu.name,
                                         imu.stream, imu.rate_hz, imu.from_s, imu.to_s)));
  for (const std::string& log : maintenance.logs) items += element("li", "", "Log: " + escaped(log));
  items += element("li", "", "Old result: " + escaped(maintenance.before));
  page.text("<ul>" + items + "</ul>\n");
  page.endSection();
}

}  // namespace
}  // namespace html

std::vector<ReportFile> maintenanceReportFiles(const Maintenance& maintenance) {
  html::ReportPage verdict, page;
  html::writeVerdictOf(maintenance, verdict);
  html::writeSteps(maintenance, page);
  html::writeQuantities(maintenance, page);
  html::writeTracks(maintenance, page);
  html::writeStops(maintenance, page);
  html::writeNotesOf(maintenance, page);
  std::vector<ReportFile> files = {
      {"report.html", html::document({"IMUs over time", maintenance.version, {}}, verdict, page)}};
  for (const html::PlotTable& table : page.tables()) files.push_back({table.file, html::tableCsv(table)});
  return files;
}

}  // namespace evical
