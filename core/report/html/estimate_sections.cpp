// Convergence, uncertainty, split-half check, and the run's notes, options and timing.
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"

#include "core/numerics/angles.h"
#include "core/report/shown_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::html {
namespace {

constexpr std::array<const char*, 3> kAxisColours = {"c0", "c1", "c2"};

// Biases of one sensor at the knots, minus their means.
struct Drift {
  std::string file, title, unit;
  const BiasDrift& knots;
  const std::vector<Eigen::Vector3d>&values, &sigmas;
};

PlotTable biasTable(const Drift& drift) {
  PlotTable table("plots/" + drift.file + ".csv",
                  {"time_s", "x [" + drift.unit + "]", "y [" + drift.unit + "]", "z [" + drift.unit + "]",
                   "std_x", "std_y", "std_z"});
  for (std::size_t k = 0; k < drift.values.size(); ++k) {
    const Eigen::Vector3d& value = drift.values[k];
    const Eigen::Vector3d sigma = k < drift.sigmas.size() ? drift.sigmas[k] : Eigen::Vector3d::Zero();
    table.add({drift.knots.knotTime_s(k), value.x(), value.y(), value.z(), sigma.x(), sigma.y(), sigma.z()});
  }
  return table;
}

void writeDrift(const Drift& drift, ReportPage& page) {
  const PlotTable table = biasTable(drift);
  PlotFrame frame;
  frame.title = drift.title + ": bias minus its mean";
  frame.x_label = "time [s]";
  frame.y_label = drift.unit;
  frame.x = rangeOf(table.values[0], 0.0);
  frame.y = rangeOf(table.values[1]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> low, high;
    for (std::size_t k = 0; k < table.rows(); ++k) {
      low.push_back(table.values[axis + 1][k] - table.values[axis + 4][k]);
      high.push_back(table.values[axis + 1][k] + table.values[axis + 4][k]);
    }
    frame.y = joined(frame.y, joined(rangeOf(low), rangeOf(high)));
  }
  SvgPlot plot(frame);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    plot.line(table.values[0], table.values[axis + 1], kAxisColours[axis]);
    for (std::size_t k = 0; k < table.rows(); ++k) {
      const double time_s = table.values[0][k], value = table.values[axis + 1][k];
      const double sigma = table.values[axis + 4][k];
      plot.segment(time_s, value - sigma, time_s, value + sigma, kAxisColours[axis]);
    }
  }
  plot.legend({{"c0", "x"}, {"c1", "y"}, {"c2", "z"}});
  page.figure(plot.svg(), "The bias is linear between knots; bars are one standard deviation at the knots.",
              &table);
  page.keep(table);
}

}  // namespace

void writeBiases(const ReportData& data, ReportPage& page) {
  const std::vector<ImuState>& imus = data.named.result->state.imus;
  if (std::all_of(imus.begin(), imus.end(), [](const ImuState& imu) { return imu.bias_drift.knots() == 0; }))
    return;
  page.beginSection("biases", "Biases over time");
  for (std::size_t i = 0; i < imus.size(); ++i) {
    const BiasDrift& drift = imus[i].bias_drift;
    if (drift.knots() == 0) continue;
    const std::vector<ImuUncertainty>& sigmas = data.named.result->uncertainty.imus;
    const ImuUncertainty sigma = i < sigmas.size() ? sigmas[i] : ImuUncertainty{};
    page.heading("IMU " + imuName(data, i));
    writeDrift({fmt::format("imu{}_gyroscope_bias", i + 1), "Gyroscope", "rad/s", drift,
                drift.gyroscope_rad_s, sigma.gyroscope_drift_std_rad_s},
               page);
    writeDrift({fmt::format("imu{}_accelerometer_bias", i + 1), "Accelerometer", "m/s\u00b2", drift,
                drift.accelerometer_m_s2, sigma.accelerometer_drift_std_m_s2},
               page);
  }
  page.endSection();
}

}  // namespace evical::html

namespace evical::html {
namespace {

PlotTable convergenceTable(const std::vector<IterationRecord>& iterations) {
  PlotTable table("plots/convergence.csv", {"iteration", "stage", "cost", "gradient", "step"});
  for (const IterationRecord& each : iterations)
    table.add({static_cast<double>(each.iteration), static_cast<double>(each.stage), each.cost, each.gradient,
               each.step});
  return table;
}

// Differences of each camera's pose and time offset from their final values, by iteration.
PlotTable distanceTable(const std::vector<IterationRecord>& iterations, std::size_t camera) {
  PlotTable table(fmt::format("plots/camera{}_convergence.csv", camera + 1),
                  {"iteration", "translation_to_last_mm", "rotation_to_last_deg", "time_offset_to_last_ms"});
  const CameraState& last = iterations.back().cameras.at(camera);
  for (const IterationRecord& each : iterations) {
    const CameraState& now = each.cameras.at(camera);
    table.add(
        {static_cast<double>(each.iteration),
         1e3 * (now.reference_from_camera.translation_m - last.reference_from_camera.translation_m).norm(),
         kDegPerRad * now.reference_from_camera.rotation.angularDistance(last.reference_from_camera.rotation),
         1e3 * std::abs(now.time_offset_s - last.time_offset_s)});
  }
  return table;
}

std::vector<double> decades(const std::vector<double>& values, double least) {
  std::vector<double> logs;
  for (const double value : values) logs.push_back(std::log10(std::max(value, least)));
  return logs;
}

PlotFrame iterationFrame(const PlotTable& table, const char* title, const char* y_label) {
  PlotFrame frame;
  frame.title = title;
  frame.x_label = "iteration";
  frame.y_label = y_label;
  frame.width = 420.0;
  frame.height = 250.0;
  frame.x = rangeOf(table.values[0], 0.02);
  return frame;
}

void writeCost(const PlotTable& table, ReportPage& page) {
  PlotFrame frame = iterationFrame(table, "cost over the iterations", "cost");
  constexpr double kWide = 20.0;  // ratio from which the scale is logarithmic
  const AxisRange range = rangeOf(table.values[2], 0.0);
  frame.y_decades = range.low > 0.0 && range.high > kWide * range.low;
  const std::vector<double> cost = frame.y_decades ? decades(table.values[2], 1e-12) : table.values[2];
  frame.y = rangeOf(cost, 0.1);
  SvgPlot plot(frame);
  for (std::size_t i = 1; i < table.rows(); ++i)
    if (table.values[1][i] != table.values[1][i - 1])
      plot.segment(table.values[0][i] - 0.5, frame.y.low, table.values[0][i] - 0.5, frame.y.high, "dashed");
  plot.line(table.values[0], cost, "c2");
  plot.points(table.values[0], cost, "c2", 5.0);
  page.figure(plot.svg(),
              "Half the sum of squares of all weighted residuals. Dashed lines separate the stages, which "
              "have different weights and free parameters: the cost must decrease within each stage only.",
              &table);
}

void writeDistances(const ReportData& data, std::size_t camera, ReportPage& page) {
  const PlotTable table = distanceTable(data.named.result->iterations, camera);
  PlotFrame frame = iterationFrame(table, "difference from the final values", "distance");
  constexpr double kMin = 1e-6;
  frame.y = rangeOf(decades(table.values[1], kMin));
  for (std::size_t k = 2; k <= 3; ++k) frame.y = joined(frame.y, rangeOf(decades(table.values[k], kMin)));
  frame.y_decades = true;
  SvgPlot plot(frame);
  for (std::size_t k = 1; k <= 3; ++k)
    plot.line(table.values[0], decades(table.values[k], kMin), fmt::format("c{}", k - 1));
  plot.legend({{"c0", "translation [mm]"}, {"c1", "rotation [deg]"}, {"c2", "time [ms]"}});
  page.figure(
      plot.svg(),
      fmt::format("Differences of {} from its final values. They should converge to well below the sigmas.",
                  escaped(cameraName(data, camera))),
      &table);
  page.keep(table);
}

std::string observabilityWords(const ReportData& data) {
  const UncertaintyReport& u = data.named.result->uncertainty;
  const auto unmet =
      std::count_if(u.observability.begin(), u.observability.end(), [](double v) { return v < 1.0; });
  std::string text = fmt::format("The least certain direction is <b>{}</b>. ", escaped(u.weakest));
  const double weakest = u.observability.front();
  text += fmt::format(
      "Relative to the required sigmas ({} deg, {} mm, {} ms) it has {} times the allowed sigma. ",
      plain(data.needs.rotation_deg), plain(data.needs.translation_mm), plain(data.needs.time_offset_ms),
      significant(1.0 / std::sqrt(std::max(weakest, 1e-12)), 2));
  text += unmet == 0 ? fmt::format("All {} directions meet the required sigmas.", u.observability.size())
                     : fmt::format("{} of {} directions do not meet the required sigmas.", unmet,
                                   u.observability.size());
  return text;
}

void writeObservability(const ReportData& data, ReportPage& page) {
  const std::vector<double>& values = data.named.result->uncertainty.observability;
  if (values.empty()) return;
  page.text(paragraph("", observabilityWords(data)));
  PlotTable table("plots/observability.csv", {"direction", "sigma_over_need"});
  for (std::size_t i = 0; i < values.size(); ++i)
    table.add({static_cast<double>(i + 1), 1.0 / std::sqrt(std::max(values[i], 1e-12))});
  PlotFrame frame;
  frame.title = "sigma relative to the required one, by direction";
  frame.x_label = "direction, the weakest first";
  frame.y_label = "sigma / required";
  frame.x = {0.0, static_cast<double>(values.size())};
  frame.y = {0.0, 1.1 * std::max(1.0, table.values[1].front())};
  frame.height = 180.0;
  frame.x_names.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) frame.x_names[i] = fmt::format("{}", i + 1);
  SvgPlot plot(frame);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double x = static_cast<double>(i), height = table.values[1][i];
    plot.bar(x + 0.2, x + 0.8, 0.0, height, height > 1.0 ? "bad" : "c1");
  }
  plot.segment(0.0, 1.0, frame.x.high, 1.0, "ink dashed");
  page.figure(plot.svg(),
              "Sigmas of independent directions relative to the required ones. Directions above the dashed "
              "line do not meet the requirement.",
              &table);
  page.keep(table);
}

std::string largestDifference(const std::vector<QuantityDifference>& quantities) {
  const auto largest = std::max_element(
      quantities.begin(), quantities.end(),
      [](const auto& a, const auto& b) { return std::abs(a.normalised()) < std::abs(b.normalised()); });
  if (largest == quantities.end()) return "";
  return fmt::format("The largest difference is in {}: {} {}, {} sigmas.", escaped(largest->name),
                     significant(largest->difference), escaped(largest->unit),
                     number(std::abs(largest->normalised()), 1));
}

PlotTable correlationTable(const UncertaintyReport& u, const std::vector<std::string>& names) {
  PlotTable table("plots/correlation.csv", {});
  table.label_column = "quantity";
  table.labels = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.columns.push_back(fmt::format("{}", i + 1));
    std::vector<double>& column = table.values.emplace_back();
    for (Eigen::Index row = 0; row < u.correlation.rows(); ++row)
      column.push_back(u.correlation(row, static_cast<Eigen::Index>(i)));
  }
  return table;
}

}  // namespace

void writeConvergence(const ReportData& data, ReportPage& page) {
  const std::vector<IterationRecord>& iterations = data.named.result->iterations;
  if (iterations.empty()) return;
  page.beginSection("convergence", "Convergence");
  const PlotTable table = convergenceTable(iterations);
  page.beginRow();
  writeCost(table, page);
  for (std::size_t i = 0; i < iterations.back().cameras.size(); ++i) writeDistances(data, i, page);
  page.endRow();
  page.keep(table);
  page.endSection();
}

void writeUncertainty(const ReportData& data, ReportPage& page) {
  const UncertaintyReport& u = data.named.result->uncertainty;
  const std::vector<std::string> names = columnNames(data.named);
  if (names.empty() && u.observability.empty()) return;
  page.beginSection("uncertainty", "Observability and correlation");
  writeObservability(data, page);
  if (!names.empty()) {
    const PlotTable table = correlationTable(u, names);
    page.figure(
        heatMapSvg("correlation of all quantities", names, u.correlation),
        "Correlation: warm colours are positive, cold ones negative; point at a cell to see its value. A "
        "strong colour off the diagonal: the recording determines these two only in combination.",
        &table);
    page.keep(table);
  }
  page.endSection();
}

void writeSplitHalfCheck(const ReportData& data, ReportPage& page) {
  const auto& validation = data.named.result->split_half_check;
  if (!validation) return;
  page.beginSection("split-half-check", "Two halves of the recording");
  if (!validation->failure.empty()) {
    page.text(paragraph("", "The halves could not be compared: " + escaped(validation->failure)));
    page.endSection();
    return;
  }
  page.text(paragraph(
      "",
      fmt::format("Estimated again from every other block of {} s ({} windows), and from the blocks between "
                  "({} windows). The two differ by <b>{} sigmas</b> (RMS over the quantities below). About 1 "
                  "is expected. More than 2 indicates errors that change more slowly than noise: a rig that "
                  "is not rigid, changing temperature, or intrinsics that do not fit.",
                  number(validation->block_s, 2), validation->windows[0], validation->windows[1],
                  number(validation->rms_sigmas, 2))));
  page.text(paragraph("", largestDifference(validation->quantities)));
  PlotTable table("plots/split_half_check.csv", {"difference", "sigma", "sigmas"});
  table.label_column = "quantity";
  PlotFrame frame;
  frame.title = "difference between the halves in sigmas";
  frame.x_label = "quantity, as numbered in the table";
  frame.y_label = "difference / sigma";
  std::vector<std::vector<std::string>> rows;
  for (const QuantityDifference& each : validation->quantities) {
    if (!(each.sigma > 0.0) || !std::isfinite(each.difference)) continue;
    table.labels.push_back(each.unit.empty() ? each.name : each.name + " [" + each.unit + "]");
    table.add({each.difference, each.sigma, each.normalised()});
    rows.push_back({fmt::format("{}", rows.size() + 1), escaped(each.name), significant(each.difference),
                    significant(each.sigma), escaped(each.unit), number(each.normalised(), 2)});
    frame.x_names.push_back(rows.size() % 2 == 1 ? fmt::format("{}", rows.size()) : "");
  }
  frame.x = {0.0, static_cast<double>(rows.size())};
  frame.y = joined({-3.2, 3.2}, rangeOf(table.values[2]));
  frame.height = 220.0;
  SvgPlot plot(frame);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double x = static_cast<double>(i), sigmas = table.values[2][i];
    plot.bar(x + 0.2, x + 0.8, 0.0, sigmas, std::abs(sigmas) > 3.0 ? "bad" : "c2");
  }
  page.figure(plot.svg(),
              "About 5 % of the differences exceed 2 sigmas by chance; a difference above 4 sigmas is not "
              "due to chance.",
              &table);
  page.text("<details><summary>All differences</summary>\n" +
            html::table({"", "quantity", "difference", "its sigma", "unit", "in sigmas"}, rows) +
            "</details>\n");
  page.keep(table);
  page.endSection();
}

void writeRun(const ReportData& data, ReportPage& page) {
  const CalibrationResult& result = *data.named.result;
  page.beginSection("run", "Faults of the recording, options, timing");
  page.heading("Faults and notes");
  std::string items;
  for (const RecordingFault& fault : data.faults) items += element("li", "", escaped(fault.text));
  page.text(items.empty() ? paragraph("", "No faults were found in the recording.")
                          : element("ul", "", items));
  items.clear();
  for (const std::string& note : result.notes) {
    const bool fault =
        std::any_of(data.faults.begin(), data.faults.end(), [&](const auto& f) { return f.text == note; });
    if (!fault) items += element("li", "", escaped(note));
  }
  if (!items.empty())
    page.text("<details open=\"open\"><summary>Notes</summary>\n" + element("ul", "", items) +
              "</details>\n");
  page.heading("Options that differ from the defaults");
  std::vector<std::vector<std::string>> rows;
  for (const OptionRow& row : data.named.options)
    rows.push_back({"<code>" + escaped(row.name) + "</code>", escaped(row.value), escaped(row.default_value),
                    escaped(row.help)});
  page.text(rows.empty() ? paragraph("", "None.") : table({"option", "value", "default", "meaning"}, rows));
  page.heading("Time and memory");
  const Timing& t = result.timing;
  page.text(
      table({"read [s]", "detect [s]", "initialise [s]", "optimise [s]", "two halves [s]", "total [s]",
             "memory [MB]"},
            {{number(t.read_s, 2), number(t.detect_s, 2), number(t.initialise_s, 2), number(t.optimise_s, 2),
              number(t.split_half_check_s, 2), number(t.total_s, 2), number(result.memory_peak_mb, 0)}}));
  page.text(
      paragraph("small", "Reading and detection overlap in time. evical " + escaped(data.named.version)));
  page.endSection();
}

}  // namespace evical::html
