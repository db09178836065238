#include "core/pipeline/pass/point_views.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/frames/frame_options.h"
#include "core/frames/ideal_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {

PointViews::PointViews(const CameraBatch& first, const ViewRequest& request)
    : board_(request.session.boardOf(first.camera)),
      stream_(request.session.cameras[first.camera].stream),
      resolution_px_(*first.opened_px),
      start_ns_(first.start_ns),
      unsaid_sigma_px_(request.session.options.frames->point_sigma_px),
      lens_(request.lens.detection_intrinsics) {
  so_far_.kind = CameraKind::Points;
}

bool PointViews::belongs(const MeasuredPoint& point) {
  ++seen_;
  if (point.point >= board_.pointCount()) {
    largest_ = std::max(largest_, point.point);
    ++unknown_;
    return false;
  }
  // Pixels extend half a pixel around their centres.
  const bool inside = point.x_px >= -0.5F && point.y_px >= -0.5F &&
                      point.x_px <= static_cast<float>(resolution_px_.width_px) - 0.5F &&
                      point.y_px <= static_cast<float>(resolution_px_.height_px) - 0.5F;
  outside_ += inside ? 0 : 1;
  return inside;
}

// A few invalid points are errors of the other program; many are of another board or another camera.
void PointViews::checkShare() const {
  constexpr std::uint64_t kEnough = 200, kMostShare = 20;
  if (seen_ < kEnough) return;
  if (kMostShare * unknown_ > seen_)
    throw badInput(
        stream_,
        fmt::format(
            "{} of {} points have indices beyond this board's: up to {}, but the board's points are 0 to {}",
            unknown_, seen_, largest_, board_.pointCount() - 1),
        board_.hasPattern()
            ? "Check type, rows and columns of the board. Points are counted row by row; an AprilGrid has "
              "four per tag, from the bottom left one"
            : "Give all points of the board in board.points_m, with the same indices as the camera's points");
  if (kMostShare * outside_ > seen_)
    throw badInput(stream_,
                   fmt::format("{} of {} points are outside {} x {} px", outside_, seen_,
                               resolution_px_.width_px, resolution_px_.height_px),
                   "Give the camera's resolution_px, and points in its raw pixels");
}

// Each point once, in order of their indices.
FoundPoints PointViews::pointsOf(const CameraBatch& batch) {
  FoundPoints points;
  for (const MeasuredPoint& measured : batch.points) {
    if (!belongs(measured)) continue;
    const double sigma_px =
        measured.sigma_px > 0.0F ? static_cast<double>(measured.sigma_px) : unsaid_sigma_px_;
    FoundPoint& point = points.emplace_back();
    point.point = measured.point;
    point.at_px = Eigen::Vector2d(measured.x_px, measured.y_px);
    point.covariance_px2 = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
  }
  const auto before = [](const FoundPoint& a, const FoundPoint& b) { return a.point < b.point; };
  const auto same = [](const FoundPoint& a, const FoundPoint& b) { return a.point == b.point; };
  std::stable_sort(points.begin(), points.end(), before);
  const auto repeated = std::unique(points.begin(), points.end(), same);
  twice_ += static_cast<std::uint64_t>(points.end() - repeated);
  points.erase(repeated, points.end());
  return points;
}

void PointViews::consume(const CameraBatch& batch) {
  if (batch.points.empty()) return;
  PointsInFrame seen;
  seen.time_s = secondsSince(start_ns_, batch.points.front().time_ns);
  seen.points = pointsOf(batch);
  checkShare();
  constexpr int kLeastPoints = 4;  // of a pose
  WindowReport window;
  window.time_s = seen.time_s;
  window.candidates = static_cast<int>(batch.points.size());
  window.circles = static_cast<int>(seen.points.size());
  window.outcome = window.circles < kLeastPoints           ? WindowOutcome::TooFewCircles
                   : window.circles == board_.pointCount() ? WindowOutcome::Complete
                                                           : WindowOutcome::Partial;
  so_far_.windows.push_back(window);
  if (window.circles >= kLeastPoints) frames_.push_back(std::move(seen));
}

BoardObservations PointViews::finish(std::vector<RecordingFault>& faults) {
  const auto earlier = [](const auto& a, const auto& b) { return a.time_s < b.time_s; };
  const auto say = [&](FaultKind kind, std::uint64_t count, const char* what) {
    if (count > 0)
      faults.push_back(
          {stream_, kind, 0.0, fmt::format("{}: {} {}", stream_, counted(count, "point"), what)});
  };
  if (!std::is_sorted(frames_.begin(), frames_.end(), earlier))
    faults.push_back({stream_, FaultKind::BackwardTime, 0.0, stream_ + ": views out of order were sorted"});
  std::stable_sort(frames_.begin(), frames_.end(), earlier);
  BoardObservations observations = so_far_;
  std::stable_sort(observations.windows.begin(), observations.windows.end(), earlier);
  say(FaultKind::Corrupt, unknown_, "excluded: the board does not have them");
  say(FaultKind::OutsideResolution, outside_, "excluded: outside the sensor");
  say(FaultKind::Corrupt, twice_, "excluded: measured twice at the same time");
  for (ViewFromFrame& made : viewsFromFrames(frames_, board_.pointCount()))
    observations.views.push_back(std::move(made.view));
  return throughLens(std::move(observations), resolution_px_.height_px, lens_);
}

}  // namespace evical
