// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_rows.h"

#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

std::vector<double> rmsOfViews_px(const CalibrationRun& run, std::size_t camera) {
  const std::size_t views = run.pass.cameras[camera].views.size();
  std::vector<double> squares(views, 0.0), rms_px(views, std::numeric_limits<double>::quiet_NaN());
  std::vector<int> counts(views, 0);
  for (const CircleResidual& residual : run.result.circle_residuals) {
    const auto view = static_cast<std::size_t>(residual.view);
    if (!residual.used || residual.camera != static_cast<int>(camera) || view >= views) continue;
    squares[view] += residual.residual_px.squaredNorm();
    ++counts[view];
  }
  for (std::size_t view = 0; view < views; ++view)
    if (counts[view] > 0) rms_px[view] = std::sqrt(squares[view] / counts[view]);
  return rms_px;
}

double speedOf_px_s(const BoardView& view) {
  std::vector<double> speeds;
  for (const CircleObservation& circle : view.circles) speeds.push_back(circle.velocity_px_s.norm());
  return medianOf(std::move(speeds), std::numeric_limits<double>::quiet_NaN());
}

// Row with the same middle; null if there is none.
WindowRow* rowOf(const BoardView& view, std::vector<WindowRow>& rows) {
  const auto row =
      std::lower_bound(rows.begin(), rows.end(), view.time_s,
                       [](const WindowRow& each, double time_s) { return each.report.time_s < time_s; });
  return row != rows.end() && row->report.time_s == view.time_s ? &*row : nullptr;
}

void addView(const BoardView& view, double rms_px, std::vector<WindowRow>& rows) {
  WindowRow* const row = rowOf(view, rows);
  if (row == nullptr) return;
  row->has_view = true;
  row->found = view.kind == ViewKind::Complete ? WindowOutcome::Complete : WindowOutcome::Partial;
  row->rms_px = rms_px;
  row->speed_px_s = speedOf_px_s(view);
}

}  // namespace

std::vector<WindowRow> windowRows(const CalibrationRun& run, std::size_t camera) {
  const BoardObservations& seen = run.pass.cameras.at(camera);
  std::vector<WindowRow> rows;
  rows.reserve(seen.windows.size());
  for (const WindowReport& report : seen.windows) rows.push_back({report, report.outcome});
  const std::vector<double> rms_px = rmsOfViews_px(run, camera);
  for (std::size_t k = 0; k < seen.views.size(); ++k) addView(seen.views[k], rms_px[k], rows);
  if (camera < run.pass.rejected_views.size())
    for (const BoardView& view : run.pass.rejected_views[camera])
      addView(view, std::numeric_limits<double>::quiet_NaN(), rows);
  return rows;
}

std::optional<double> middleOfSeen_s(const std::vector<WindowReport>& windows) {
  if (windows.empty()) return std::nullopt;
  const double middle_s = 0.5 * (windows.front().time_s + windows.back().time_s);
  for (const WindowOutcome wanted : {WindowOutcome::Complete, WindowOutcome::Partial}) {
    std::optional<double> nearest_s;
    for (const WindowReport& window : windows)
      if (window.outcome == wanted &&
          (!nearest_s || std::abs(window.time_s - middle_s) < std::abs(*nearest_s - middle_s)))
        nearest_s = window.time_s;
    if (nearest_s) return nearest_s;
  }
  return std::nullopt;
}

}  // namespace evical::ui
