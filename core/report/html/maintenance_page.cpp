#include "core/base/nearest_name.h"
#include "core/base/number.h"
#include "core/report/assessment_report.h"
#include "core/report/html/assessment_section.h"
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace evical {
namespace html {
namespace {

constexpr std::array<const char*, 3> kPartColours = {"c0", "c1", "c2"};
constexpr std::size_t kMaxPoints = 2000;  // of a plot; the CSV file of the maintenance has all

void writeSteps(const Maintenance& maintenance, ReportPage& page) {
  if (maintenance.steps.empty()) return;
  page.beginSection("steps", "Detected changes");
  std::vector<std::vector<std::string>> rows;
  for (const MaintenanceStep& step : maintenance.steps)
    rows.push_back({number(step.at_s, 1), number(step.noticed_s, 1), findingHtml(step), changeHtml(step),
                    escaped(evical::joined(step.alternatives))});
  page.text(table({"time, s", "detected at, s", "quantity", "change", "alternative"}, rows));
  page.endSection();
}

// Numbers of one unit in one plot, with a band of one sigma as faint lines.
void drawTracked(const MaintenanceTrack& track, const TrackedQuantity& quantity, const std::string& file,
                 const Maintenance& maintenance, ReportPage& page) {
  const std::size_t count = quantity.numbers.size();
  std::vector<std::string> names = {"time_s"};
  for (const TrackedNumber& each : quantity.numbers) {
    names.push_back(columnOf(quantity, each));
    names.push_back("std of " + names.back());
  }
  PlotTable plotted(file, names);
  const std::size_t stride = strideFor(track.times_s.size(), kMaxPoints);
  for (std::size_t k = 0; k < track.times_s.size(); k += stride) {
    std::vector<double> row = {track.times_s[k]};
    for (const TrackedNumber& each : quantity.numbers) {
      row.push_back(each.values[k]);
      row.push_back(each.sigmas[k]);
    }
    plotted.add(row);
  }
  if (plotted.rows() < 2) return;
  // The first values have large sigmas, which would compress the scale.
  const std::size_t skipped = std::min<std::size_t>(plotted.rows() / 10, 10);
  PlotFrame frame;
  frame.title = fmt::format("{} of {}", quantity.title, ofSensor(track.sensor, track.against));
  frame.x_label = "s";
  frame.y_label = quantity.unit;
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
    const std::string& part = quantity.numbers[c].name;
    legend.push_back({colour, part.empty() ? quantity.title : part});
  }
  plot.legend(legend);
  page.figure(plot.svg(),
              "Difference from the old calibration, as estimated at each time. Faint lines are one standard "
              "deviation to either side, a dark line is a detected change.",
              &plotted);
  page.keep(plotted);
}

void writeTracks(const Maintenance& maintenance, ReportPage& page) {
  if (maintenance.tracks.empty()) return;
  page.beginSection("tracks", "Over time");
  int picture = 0;
  for (const MaintenanceTrack& track : maintenance.tracks)
    for (const TrackedQuantity& quantity : track.quantities)
      drawTracked(track, quantity, fmt::format("plots/track{}.csv", ++picture), maintenance, page);
  page.endSection();
}

void drawStops(const MaintainedImu& imu, const std::string& file, ReportPage& page) {
  PlotTable plotted(file, {"time_s", "residual_m_s2", "sigma_m_s2", "used"});
  for (const MaintainedStop& stop : imu.stops)
    plotted.add(
        {0.5 * (stop.from_s + stop.to_s), stop.residual_m_s2, stop.sigma_m_s2, stop.used ? 1.0 : 0.0});
  PlotFrame frame;
  frame.title = fmt::format("residual of gravity's norm at stops, {}", imu.name);
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
              "Norm of each stop's specific force minus gravity, with the current parameters; bars are one "
              "standard deviation. Red stops contradict the others and are excluded.",
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
    page.text(paragraph("", fmt::format("{}. Weakest direction: {}.", counted(imu.stops.size(), "stop"),
                                        escaped(imu.weakest))));
    drawStops(imu, fmt::format("plots/stops{}.csv", picture), page);
  }
  page.endSection();
}

void writeNotesOf(const Maintenance& maintenance, ReportPage& page) {
  page.beginSection("run", "Notes");
  std::vector<std::string> texts = maintenance.notes;
  for (const MaintainedImu& imu : maintenance.imus)
    texts.push_back(fmt::format("{}: stream {}, {:.1f} Hz, from {:.1f} s to {:.1f} s", imu.name, imu.stream,
                                imu.rate_hz, imu.from_s, imu.to_s));
  for (const std::string& log : maintenance.inputs) texts.push_back("Log: " + log);
  texts.push_back("Old result: " + maintenance.before);
  writeTexts(texts, page);
  page.endSection();
}

}  // namespace
}  // namespace html

std::vector<ReportFile> reportFiles(const Maintenance& maintenance) {
  html::ReportPage verdict, page;
  html::writeAssessmentVerdict(maintenance, "Is the IMUs' calibration still good?", verdict);
  html::writeSteps(maintenance, page);
  if (!maintenance.findings.empty()) {
    page.beginSection("findings", "Since the calibration");
    html::writeFindings(maintenance, page);
    page.endSection();
  }
  html::writeTracks(maintenance, page);
  html::writeStops(maintenance, page);
  html::writeNotesOf(maintenance, page);
  return html::filesOf({"IMUs over time", maintenance.version, {}}, verdict, page);
}

}  // namespace evical
