// Sections about the detections: positions and times of the board, and motion of the rig.
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::html {
namespace {

constexpr std::array<const char*, kWindowOutcomeCount> kOutcomeClasses = {
    "o0", "o1", "o2", "o3", "o4", "o5", "o6", "o7", "o8", "o9", "o10", "o11", "o12"};

// Runs of windows with one outcome.
PlotTable timelineTable(const BoardObservations& camera, std::size_t index) {
  PlotTable runs(fmt::format("plots/camera{}_timeline.csv", index + 1),
                 {"outcome_code", "begin_s", "end_s", "windows"});
  runs.label_column = "outcome";
  for (std::size_t begin = 0, end = 0; begin < camera.windows.size(); begin = end) {
    const WindowReport& first = camera.windows[begin];
    while (end < camera.windows.size() && camera.windows[end].outcome == first.outcome) ++end;
    const WindowReport& last = camera.windows[end - 1];
    // Windows overlap: a run ends where the next one begins.
    const double middle_s =
        end < camera.windows.size() ? 0.5 * (last.time_s + camera.windows[end].time_s) : last.time_s;
    const double begin_s = runs.rows() == 0 ? first.time_s : runs.values[2].back();
    runs.labels.emplace_back(windowOutcomeName(first.outcome));
    runs.add({static_cast<double>(first.outcome), begin_s, middle_s, static_cast<double>(end - begin)});
  }
  return runs;
}

PlotTable circlesTable(const BoardObservations& camera, std::size_t index) {
  constexpr std::size_t kMax = 1500;
  PlotTable counts(fmt::format("plots/camera{}_windows.csv", index + 1), {"time_s", "circles", "candidates"});
  const std::size_t stride = strideFor(camera.windows.size(), kMax);
  for (std::size_t i = 0; i < camera.windows.size(); i += stride) {
    const WindowReport& window = camera.windows[i];
    counts.add({window.time_s, static_cast<double>(window.circles), static_cast<double>(window.candidates)});
  }
  return counts;
}

std::string timelineSvg(const PlotTable& runs, const PlotTable& counts, const CameraMeasures& camera,
                        int on_board) {
  PlotFrame frame;
  frame.title = "event windows over time by outcome";
  frame.x_label = "time [s]";
  frame.y_label = "points in the grid";
  frame.x = {runs.values[1].front(), std::max(runs.values[2].back(), runs.values[1].front() + 1e-3)};
  frame.y = {0.0, 1.35 * on_board};
  frame.height = 220.0;
  SvgPlot plot(frame);
  for (std::size_t row = 0; row < runs.rows(); ++row) {
    plot.bar(runs.values[1][row], runs.values[2][row], 1.1 * on_board, 1.3 * on_board,
             kOutcomeClasses.at(static_cast<std::size_t>(runs.values[0][row])));
  }
  plot.points(counts.values[0], counts.values[1], "ink", 2.2);
  std::vector<LegendEntry> legend;
  for (std::size_t k = 0; k < kWindowOutcomeCount; ++k)
    if (camera.outcomes[k] > 0)
      legend.push_back({kOutcomeClasses[k], windowOutcomeName(static_cast<WindowOutcome>(k))});
  plot.legend(legend);
  return plot.svg();
}

std::string outcomeTable(const CameraMeasures& camera) {
  static constexpr std::array<const char*, kWindowOutcomeCount> kMeaning = {
      "the whole board",
      "part of the board, with enough points to identify them",
      "almost no motion, or nothing in view",
      "too few candidates for circles or corners: board out of view, blurred, or of low contrast",
      "candidates that do not form a lattice",
      "a lattice of too few points: only a small part of the board in view",
      "several placements of the board explain the events equally well",
      "points lost in the joint fit of all points: blur or clutter",
      "the board moved too far during the exposure of the frame",
      "a damaged image",
      "the board was found, but the event window was rejected by hand because of its residuals",
      "the board's squares, or the borders of its tags, are too narrow in the image",
      "corners of the board, but the tags between them are not those of the session"};
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < kWindowOutcomeCount; ++k) {
    if (camera.outcomes[k] == 0) continue;
    rows.push_back({fmt::format("<span class=\"key {}\"></span>{}", kOutcomeClasses[k],
                                escaped(windowOutcomeName(static_cast<WindowOutcome>(k)))),
                    fmt::format("{}", camera.outcomes[k]),
                    number(100.0 * camera.outcomes[k] / std::max(1, camera.windows), 1) + "\u00a0%",
                    kMeaning[k]});
  }
  return table({"outcome", "windows", "share", "meaning"}, rows);
}

PlotTable cellTable(const CameraMeasures& camera, std::size_t index) {
  PlotTable cells(fmt::format("plots/camera{}_coverage.csv", index + 1),
                  {"x_low_px", "x_high_px", "y_low_px", "y_high_px", "circles"});
  for (const SensorCell& cell : camera.cells)
    cells.add({cell.low_px.x(), cell.high_px.x(), cell.low_px.y(), cell.high_px.y(),
               static_cast<double>(cell.circles)});
  return cells;
}

void writeImageCoverage(const CameraMeasures& camera, std::size_t index, ReportPage& page) {
  constexpr std::size_t kMax = 4000;
  if (!camera.resolution_px.known()) return;
  PlotTable centres(fmt::format("plots/camera{}_centres.csv", index + 1), {"x_px", "y_px"});
  for (std::size_t i = 0; i < camera.centres_px.size(); i += strideFor(camera.centres_px.size(), kMax))
    centres.add({camera.centres_px[i].x(), camera.centres_px[i].y()});
  SvgPlot scatter(
      imageFrame(camera.resolution_px.width_px, camera.resolution_px.height_px, "points over the image"));
  scatter.points(centres.values[0], centres.values[1], "c2 faint", 2.4);
  const PlotTable cells = cellTable(camera, index);
  double most = 1.0;
  for (const double count : cells.values[4]) most = std::max(most, count);
  SvgPlot map(imageFrame(camera.resolution_px.width_px, camera.resolution_px.height_px,
                         "points in each part of the image"));
  for (std::size_t i = 0; i < cells.rows(); ++i) {
    const auto& v = cells.values;
    if (v[4][i] > 0.0) map.bar(v[0][i], v[1][i], v[2][i], v[3][i], "c2", 0.12 + 0.7 * v[4][i] / most);
    map.text(0.5 * (v[0][i] + v[1][i]), 0.5 * (v[2][i] + v[3][i]), fmt::format("{:.0f}", v[4][i]), "middle",
             4.0);
  }
  page.beginRow();
  page.figure(
      scatter.svg(),
      fmt::format(
          "Measured centres or corners (one in {} shown). In empty corners the lens model is not verified.",
          strideFor(camera.centres_px.size(), kMax)),
      &centres);
  page.figure(map.svg(),
              fmt::format("Number of points in each part of the image: {} % of the parts have at least one.",
                          number(100.0 * camera.coveredShare(), 0)),
              &cells);
  page.endRow();
  page.keep(centres);
  page.keep(cells);
}

SvgPlot angleScatter(const PlotTable& poses, std::size_t a, std::size_t b, const char* title, const char* x,
                     const char* y) {
  PlotFrame frame;
  frame.title = title;
  frame.x_label = x;
  frame.y_label = y;
  frame.width = 420.0;
  frame.height = 300.0;
  frame.x = rangeOf(poses.values[a]);
  frame.y = rangeOf(poses.values[b]);
  SvgPlot plot(frame);
  plot.points(poses.values[a], poses.values[b], "c1", 3.0);
  return plot;
}

void writeBoardPoses(const CameraMeasures& camera, std::size_t index, ReportPage& page) {
  constexpr std::size_t kMax = 2000;
  if (camera.poses.empty()) return;
  PlotTable poses(fmt::format("plots/camera{}_board_poses.csv", index + 1),
                  {"time_s", "distance_m", "tilt_x_deg", "tilt_y_deg", "turn_deg"});
  for (std::size_t i = 0; i < camera.poses.size(); i += strideFor(camera.poses.size(), kMax)) {
    const BoardPose& pose = camera.poses[i];
    poses.add({pose.time_s, pose.distance_m, pose.tilt_x_deg, pose.tilt_y_deg, pose.turn_deg});
  }
  page.beginRow();
  page.figure(angleScatter(poses, 2, 3, "tilt of the board relative to the camera",
                           "tilt about the camera's x axis [deg]", "tilt about its y axis [deg]")
                  .svg(),
              "Tilts of the board. A wide spread in both directions separates distance from rotation.",
              &poses);
  page.figure(angleScatter(poses, 4, 1, "rotation about the optical axis and distance",
                           "rotation about the optical axis [deg]", "distance to the board [m]")
                  .svg(),
              "Rotations about the optical axis, and distances.", &poses);
  page.endRow();
  page.keep(poses);
}

PlotTable excitationTable(const ImuMeasures& imu, std::size_t index) {
  PlotTable table(fmt::format("plots/imu{}_excitation.csv", index + 1),
                  {"rate_rms_rad_s", "rate_largest_rad_s", "force_rms_m_s2", "force_largest_m_s2"});
  table.label_column = "axis";
  table.labels = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    table.add({imu.rate_rad_s.deviation[k], imu.rate_rad_s.largest[k], imu.force_m_s2.deviation[k],
               imu.force_m_s2.largest[k]});
  return table;
}

std::string excitationSvg(const PlotTable& table, std::size_t rms, std::size_t largest, const char* title,
                          const char* unit) {
  PlotFrame frame;
  frame.title = title;
  frame.x_label = "axis of the IMU";
  frame.x_names = {"x", "y", "z"};
  frame.y_label = unit;
  frame.width = 420.0;
  frame.height = 240.0;
  frame.x = {0.0, 3.0};
  frame.y = {0.0, 1.08 * std::max(1e-3, *std::max_element(table.values[largest].begin(),
                                                          table.values[largest].end()))};
  SvgPlot plot(frame);
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = static_cast<double>(k);
    const std::string colour = fmt::format("c{}", k);
    plot.bar(x + 0.2, x + 0.8, 0.0, table.values[largest][k], colour, 0.3);
    plot.bar(x + 0.2, x + 0.8, 0.0, table.values[rms][k], colour);
    plot.text(x + 0.5, table.values[rms][k], significant(table.values[rms][k], 2), "middle", -4.0);
  }
  return plot.svg();
}

}  // namespace

void writeDetections(const ReportData& data, const Measures& measures, ReportPage& page) {
  if (std::all_of(measures.cameras.begin(), measures.cameras.end(),
                  [](const auto& c) { return c.windows == 0; }))
    return;
  page.beginSection("detections", "Detections over time");
  for (std::size_t i = 0; i < measures.cameras.size(); ++i) {
    const CameraMeasures& camera = measures.cameras[i];
    if (camera.windows == 0) continue;
    page.heading("Camera " + cameraName(data, i));
    const int points = data.boards.at(i).board.pointCount();
    const PlotTable runs = timelineTable(data.cameras[i], i), counts = circlesTable(data.cameras[i], i);
    page.figure(
        timelineSvg(runs, counts, camera, points),
        fmt::format(
            "The bar shows each event window's outcome, the dots the number of found points (the board "
            "has {}). Stretches without the board do not contribute to the calibration.",
            points),
        &runs);
    page.text(outcomeTable(camera));
    page.keep(runs);
    page.keep(counts);
  }
  page.endSection();
}

void writeCoverage(const ReportData& data, const Measures& measures, ReportPage& page) {
  if (std::all_of(measures.cameras.begin(), measures.cameras.end(),
                  [](const auto& c) { return c.views == 0; }))
    return;
  page.beginSection("coverage", "Coverage of the image, and of the board's tilt");
  for (std::size_t i = 0; i < measures.cameras.size(); ++i) {
    if (measures.cameras[i].views == 0) continue;
    page.heading("Camera " + cameraName(data, i));
    writeImageCoverage(measures.cameras[i], i, page);
    writeBoardPoses(measures.cameras[i], i, page);
  }
  page.endSection();
}

void writeExcitation(const ReportData& data, const Measures& measures, ReportPage& page) {
  if (std::all_of(measures.imus.begin(), measures.imus.end(),
                  [](const auto& imu) { return imu.rate_hz == 0.0; }))
    return;
  page.beginSection("excitation", "Excitation per axis");
  for (std::size_t i = 0; i < measures.imus.size(); ++i) {
    const ImuMeasures& imu = measures.imus[i];
    page.heading("IMU " + imuName(data, i));
    const PlotTable table = excitationTable(imu, i);
    page.beginRow();
    page.figure(
        excitationSvg(table, 0, 1, "rotation about each axis", "rad/s"),
        "Angular rate about the IMU's axes: RMS (solid) and maximum (pale). If there is little rotation "
        "about an axis, the rotation, and the translation along the other axes, are poorly constrained.",
        &table);
    page.figure(excitationSvg(table, 2, 3, "acceleration along each axis", "m/s\u00b2"),
                "Specific force along the IMU's axes minus its mean: RMS (solid) and maximum (pale).",
                &table);
    page.endRow();
    page.text(paragraph(
        "small", fmt::format("{} samples/s over {} s.", number(imu.rate_hz, 1), number(imu.duration_s, 1))));
    page.keep(table);
  }
  page.endSection();
}

}  // namespace evical::html
