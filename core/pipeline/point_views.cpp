#include "core/pipeline/point_views.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/frames/ideal_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace evical {
namespace {

constexpr double kUnsaidSigma_px =
    0.2;  // of corners as detectors give them; what they scatter is found anyway

// Where one point was, view by view.
using Track = std::vector<std::pair<double, CircleObservation*>>;

Eigen::Vector2d velocityBetween_px_s(const Track& track, std::size_t i) {
  constexpr double kNear_s = 0.3;
  const std::size_t before = i > 0 && track[i].first - track[i - 1].first < kNear_s ? i - 1 : i;
  const std::size_t behind =
      i + 1 < track.size() && track[i + 1].first - track[i].first < kNear_s ? i + 1 : i;
  const double time_s = track[behind].first - track[before].first;
  if (time_s <= 0.0) return Eigen::Vector2d::Zero();
  return (track[behind].second->centre_px - track[before].second->centre_px) / time_s;
}

}  // namespace

void setVelocities(BoardObservations& observations) {
  std::map<int, Track> tracks;
  for (BoardView& view : observations.views)
    for (CircleObservation& circle : view.circles) tracks[circle.circle].push_back({view.time_s, &circle});
  for (const auto& [point, track] : tracks)
    for (std::size_t i = 0; i < track.size(); ++i)
      track[i].second->velocity_px_s = velocityBetween_px_s(track, i);
}

PointViews::PointViews(const Board& board, std::string stream, const CameraBatch& first,
                       const std::optional<CameraIntrinsics>& lens)
    : board_(board),
      stream_(std::move(stream)),
      resolution_px_(*first.opened_px),
      start_ns_(first.start_ns),
      lens_(lens) {
  observations_.kind = CameraKind::Points;
}

bool PointViews::belongs(const MeasuredPoint& point) {
  ++seen_;
  if (point.point >= board_.pointCount()) {
    largest_ = std::max(largest_, point.point);
    ++unknown_;
    return false;
  }
  // Pixels reach half a pixel beyond their centres.
  const bool inside = point.x_px >= -0.5F && point.y_px >= -0.5F &&
                      point.x_px <= static_cast<float>(resolution_px_.width_px) - 0.5F &&
                      point.y_px <= static_cast<float>(resolution_px_.height_px) - 0.5F;
  outside_ += inside ? 0 : 1;
  return inside;
}

// A few are somebody's mistakes; many are of another board or another camera.
void PointViews::checkShare() const {
  constexpr std::uint64_t kEnough = 200, kMostShare = 20;
  if (seen_ < kEnough) return;
  if (kMostShare * unknown_ > seen_)
    throw badInput(
        stream_,
        fmt::format("{} of {} points have indices that this board does not have: up to {}, but the "
                    "board's points are 0 to {}",
                    unknown_, seen_, largest_, board_.pointCount() - 1),
        "Check type, rows and cols of the board; points are counted row by row, an AprilGrid's "
        "four a tag from the bottom left one");
  if (kMostShare * outside_ > seen_)
    throw badInput(stream_,
                   fmt::format("{} of {} points lie outside {} x {} px", outside_, seen_,
                               resolution_px_.width_px, resolution_px_.height_px),
                   "Give the camera's own resolution_px, and points in its own pixels");
}

void PointViews::take(const CameraBatch& batch) {
  if (batch.points.empty()) return;
  BoardView view;
  view.time_s = secondsSince(start_ns_, batch.points.front().time_ns);
  for (const MeasuredPoint& point : batch.points) {
    if (!belongs(point)) continue;
    CircleObservation circle;
    circle.circle = point.point;
    circle.time_s = view.time_s;
    circle.centre_px = Eigen::Vector2d(point.x_px, point.y_px);
    const double sigma_px = point.sigma_px > 0.0F ? static_cast<double>(point.sigma_px) : kUnsaidSigma_px;
    circle.rows_below_middle = circle.centre_px.y() - 0.5 * (resolution_px_.height_px - 1);
    circle.covariance_px2 = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
    view.circles.push_back(circle);
  }
  checkShare();
  const auto before = [](const CircleObservation& a, const CircleObservation& b) {
    return a.circle < b.circle;
  };
  const auto same = [](const CircleObservation& a, const CircleObservation& b) {
    return a.circle == b.circle;
  };
  std::stable_sort(view.circles.begin(), view.circles.end(), before);
  const auto repeated = std::unique(view.circles.begin(), view.circles.end(), same);
  twice_ += static_cast<std::uint64_t>(view.circles.end() - repeated);
  view.circles.erase(repeated, view.circles.end());
  const auto count = static_cast<int>(view.circles.size());
  view.kind = count == board_.pointCount() ? ViewKind::Complete : ViewKind::Partial;
  constexpr int kLeastPoints = 4;  // of a pose
  WindowReport window;
  window.time_s = view.time_s;
  window.candidates = static_cast<int>(batch.points.size());
  window.circles = count;
  window.outcome = count < kLeastPoints              ? WindowOutcome::TooFewCircles
                   : view.kind == ViewKind::Complete ? WindowOutcome::Complete
                                                     : WindowOutcome::Partial;
  observations_.windows.push_back(window);
  if (count >= kLeastPoints) observations_.views.push_back(std::move(view));
}

BoardObservations PointViews::finish(std::vector<RecordingFault>& faults) {
  const auto earlier = [](const auto& a, const auto& b) { return a.time_s < b.time_s; };
  const auto say = [&](FaultKind kind, std::uint64_t count, const char* what) {
    if (count > 0)
      faults.push_back({stream_, kind, 0.0, fmt::format("{}: {} points {}", stream_, count, what)});
  };
  if (!std::is_sorted(observations_.views.begin(), observations_.views.end(), earlier))
    faults.push_back({stream_, FaultKind::BackwardTime, 0.0, stream_ + ": views out of order, sorted"});
  std::stable_sort(observations_.views.begin(), observations_.views.end(), earlier);
  std::stable_sort(observations_.windows.begin(), observations_.windows.end(), earlier);
  say(FaultKind::Corrupt, unknown_, "left out that the board does not have");
  say(FaultKind::OutsideResolution, outside_, "outside the sensor left out");
  say(FaultKind::Corrupt, twice_, "left out that were measured twice at the same time");
  setVelocities(observations_);
  return lens_ ? inIdealPixels(observations_, *lens_) : std::move(observations_);
}

}  // namespace evical
