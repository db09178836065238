#include "core/report/detections_csv.h"

#include "core/report/csv_text.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

namespace evical {
namespace {

constexpr int kLargestCount = std::numeric_limits<int>::max();

// Columns in the order of the functions below.
const std::vector<std::string> kDetectionColumns = {"camera",
                                                    "window_time_s",
                                                    "grid",
                                                    "circle",
                                                    "time_s",
                                                    "x_px",
                                                    "y_px",
                                                    "var_x_px2",
                                                    "cov_xy_px2",
                                                    "var_y_px2",
                                                    "vx_px_s",
                                                    "vy_px_s",
                                                    "major_px",
                                                    "minor_px",
                                                    "angle_rad",
                                                    "bursts",
                                                    "residual_rms_px",
                                                    "edge_localisation_bias_effect_x",
                                                    "edge_localisation_bias_effect_y",
                                                    "rows_below_middle",
                                                    "longer_exposed_s"};
const std::vector<std::string> kWindowColumns = {"camera", "time_s",     "half_width_s", "outcome",
                                                 "bursts", "candidates", "circles",      "tracked"};
const std::vector<std::string_view> kGrids = {"complete", "partial"};  // in ViewKind's order

void writeCircle(const std::string& camera, const BoardView& view, const CircleObservation& c,
                 std::string& text) {
  fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                 camera, view.time_s, kGrids[static_cast<std::size_t>(view.kind)], c.circle, c.time_s,
                 c.centre_px.x(), c.centre_px.y(), c.covariance_px2(0, 0), c.covariance_px2(0, 1),
                 c.covariance_px2(1, 1), c.velocity_px_s.x(), c.velocity_px_s.y(), c.semi_axes_px.x(),
                 c.semi_axes_px.y(), c.angle_rad, c.events, c.residual_rms_px,
                 c.edge_localisation_bias_effect.x(), c.edge_localisation_bias_effect.y(),
                 c.rows_below_middle, c.longer_exposed_s);
}

CircleObservation circleFrom(const CsvReader& line, int points_of_board) {
  CircleObservation c;
  c.circle = line.integer(3, 0, points_of_board - 1);
  c.time_s = line.real(4);
  c.centre_px = {line.real(5), line.real(6)};
  c.covariance_px2(0, 0) = line.real(7);
  c.covariance_px2(0, 1) = c.covariance_px2(1, 0) = line.real(8);
  c.covariance_px2(1, 1) = line.real(9);
  if (!(c.covariance_px2(0, 0) > 0.0 && c.covariance_px2.determinant() > 0.0))
    throw line.error(7, "and the next two columns are not a valid covariance");
  c.velocity_px_s = {line.real(10), line.real(11)};
  c.semi_axes_px = {line.real(12), line.real(13)};
  c.angle_rad = line.real(14);
  c.events = line.integer(15, 0, kLargestCount);
  c.residual_rms_px = line.real(16);
  c.edge_localisation_bias_effect = {line.real(17), line.real(18)};
  c.rows_below_middle = line.real(19);
  c.longer_exposed_s = line.real(20);
  return c;
}

WindowReport windowFrom(const CsvReader& line, const std::vector<std::string_view>& outcomes) {
  WindowReport w;
  w.time_s = line.real(1);
  w.half_width_s = line.real(2);
  w.outcome = static_cast<WindowOutcome>(line.choice(3, outcomes));
  w.events = line.integer(4, 0, kLargestCount);
  w.candidates = line.integer(5, 0, kLargestCount);
  w.circles = line.integer(6, 0, kLargestCount);
  w.tracked = line.integer(7, 0, 1) == 1;
  return w;
}

BoardObservations& cameraOf(const std::string& name, std::vector<BoardObservations>& cameras) {
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const BoardObservations& camera) { return camera.camera == name; });
  if (found != cameras.end()) return *found;
  cameras.emplace_back().camera = name;
  return cameras.back();
}

template <class Items>
void checkOrder(const Items& items, const CsvReader& line) {
  if (items.size() > 1 && items.back().time_s < items[items.size() - 2].time_s)
    throw line.error(1, "decreases");
}

// The circles of a view are consecutive, in order of their indices.
void addCircle(const CsvReader& line, int points_of_board, std::vector<BoardView>& views) {
  const CircleObservation circle = circleFrom(line, points_of_board);
  const double time_s = line.real(1);
  const auto kind = static_cast<ViewKind>(line.choice(2, kGrids));
  if (views.empty() || views.back().time_s != time_s || views.back().circles.back().circle >= circle.circle) {
    views.push_back({time_s, kind, {}});
    checkOrder(views, line);
  }
  views.back().circles.push_back(circle);
}

}  // namespace

void detectionsCsv(const std::vector<BoardObservations>& cameras, const TextSink& sink) {
  sink(fmt::format("{}\n", fmt::join(kDetectionColumns, ",")));
  std::string text;
  for (const BoardObservations& camera : cameras) {
    const std::string name = csvWord(camera.camera);
    for (const BoardView& view : camera.views) {
      text.clear();
      for (const CircleObservation& circle : view.circles) writeCircle(name, view, circle, text);
      sink(text);
    }
  }
}

std::string detectionsCsv(const std::vector<BoardObservations>& cameras) {
  return wholeText([&](const TextSink& sink) { detectionsCsv(cameras, sink); });
}

std::string windowsCsv(const std::vector<BoardObservations>& cameras) {
  std::string text = fmt::format("{}\n", fmt::join(kWindowColumns, ","));
  for (const BoardObservations& camera : cameras)
    for (const WindowReport& w : camera.windows)
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", csvWord(camera.camera), w.time_s,
                     w.half_width_s, windowOutcomeName(w.outcome), w.events, w.candidates, w.circles,
                     w.tracked ? 1 : 0);
  return text;
}

std::vector<BoardObservations> readDetections(const std::filesystem::path& folder, int points_of_board) {
  std::vector<BoardObservations> cameras;
  std::vector<std::string_view> outcomes;
  for (std::size_t k = 0; k < kWindowOutcomeCount; ++k)
    outcomes.emplace_back(windowOutcomeName(static_cast<WindowOutcome>(k)));
  for (CsvReader line(folder / "windows.csv", kWindowColumns); line.next();) {
    std::vector<WindowReport>& windows = cameraOf(line.text(0), cameras).windows;
    windows.push_back(windowFrom(line, outcomes));
    checkOrder(windows, line);
  }
  for (CsvReader line(folder / "detections.csv", kDetectionColumns); line.next();)
    addCircle(line, points_of_board, cameraOf(line.text(0), cameras).views);
  return cameras;
}

}  // namespace evical
