#include "core/frames/frame_tracker.h"

#include "core/frames/board_finder.h"
#include "core/frames/views_from_frames.h"

#include <algorithm>
#include <utility>

namespace evical {
namespace {

// Frames with longer gaps do not predict the board's place.
constexpr double kLongestPrediction_s = 0.5;

// The same points, numbered from the board's other end.
FoundPoints turned(const FoundPoints& points, int count) {
  FoundPoints other(points.rbegin(), points.rend());
  for (FoundPoint& point : other) point.point = count - 1 - point.point;
  return other;
}

double meanDistance_px(const FoundPoints& points, const Board& board, const PlaneMap& map) {
  double sum = 0.0;
  for (const FoundPoint& point : points) sum += (map.at(board.point_m(point.point)) - point.at_px).norm();
  return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

}  // namespace

bool FrameRate::isDue(double time_s) {
  // Tolerates jitter of stamps: frames at exactly this rate are all used.
  constexpr double kJitter = 0.1;
  if (due_s_ && time_s < *due_s_ - kJitter * period_s_) return false;
  due_s_ = (due_s_ && time_s < *due_s_ + period_s_ ? *due_s_ : time_s) + period_s_;
  return true;
}

FrameTracker::FrameTracker(std::string camera, const Board& board, const FrameOptions& options)
    : camera_(std::move(camera)), board_(board), options_(options), finder_(board, options) {}

// Prediction with the motion between the last two views.
std::optional<PlaneMap> FrameTracker::predicted(double time_s) const {
  if (seen_.empty() || time_s - seen_.back().time.time_s > kLongestPrediction_s) return std::nullopt;
  const Seen& last = seen_.back();
  FoundPoints expected = last.points;
  if (seen_.size() > 1 && last.time.time_s - seen_[seen_.size() - 2].time.time_s < kLongestPrediction_s) {
    const Seen& before = seen_[seen_.size() - 2];
    const std::optional<PlaneMap> then = mapOf(before.points, board_);
    const double gaps = (time_s - last.time.time_s) / (last.time.time_s - before.time.time_s);
    if (then)
      for (FoundPoint& point : expected)
        point.at_px += gaps * (point.at_px - then->at(board_.point_m(point.point)));
  }
  return mapOf(expected, board_);
}

// Measures with a wide gate first; then each point must be close to its place according to the others, and
// missed points are searched there.
FoundPoints FrameTracker::follow(const GrayImage& image, double time_s) const {
  const std::optional<PlaneMap> map = predicted(time_s);
  if (!map) return {};
  const std::size_t before = seen_.back().points.size();
  const auto enough = [&](const FoundPoints& points) { return 4 * points.size() >= 3 * before; };
  FoundPoints found = finder_.measure(image, *map, options_.prediction_gate_px);
  if (!enough(found)) return {};
  const std::optional<PlaneMap> nearer = mapOf(found, board_);
  if (!nearer) return {};
  if (static_cast<int>(found.size()) < board_.pointCount())
    found = finder_.measure(image, *nearer, options_.max_move_px);
  else
    std::erase_if(found, [&](const FoundPoint& point) {
      return (nearer->at(board_.point_m(point.point)) - point.at_px).norm() > options_.max_move_px;
    });
  return enough(found) ? found : FoundPoints{};
}

FoundPoints FrameTracker::search(const GrayImage& image, double time_s) {
  followed_ = 0;
  FoundPoints found = finder_.find(image);
  if (finder_.renumbered()) dropEarlier();
  const std::optional<PlaneMap> map = predicted(time_s);
  if (!board_.hasHalfTurnAmbiguity() || !map || found.empty()) return found;
  // A board with half-turn symmetry keeps the numbering of the last view.
  FoundPoints other = turned(found, board_.pointCount());
  return meanDistance_px(other, board_, *map) < meanDistance_px(found, board_, *map) ? other : found;
}

void FrameTracker::dropEarlier() {
  for (const Seen& seen : seen_) {
    windows_[seen.window].outcome = WindowOutcome::Ambiguous;
    windows_[seen.window].circles = 0;
  }
  seen_.clear();
}

void FrameTracker::track(const GrayImage& image, const FrameTime& time) {
  FoundPoints followed, found;
  const bool search_now = followed_++ >= options_.search_every_frames;
  if (!search_now) followed = follow(image, time.time_s);
  if (followed.empty()) found = search(image, time.time_s);
  // Tracking may succeed without a search if the board is partly outside the frame.
  if (found.empty() && search_now) followed = follow(image, time.time_s);
  const bool tracked = found.empty() && !followed.empty();
  report(time, std::move(tracked ? followed : found), tracked);
}

void FrameTracker::report(const FrameTime& time, FoundPoints points, bool tracked) {
  const std::size_t count = static_cast<std::size_t>(board_.pointCount());
  WindowReport window;
  window.time_s = time.time_s;
  window.half_width_s = 0.5 * time.exposure_s;
  window.candidates = window.circles = static_cast<int>(points.size());
  window.tracked = tracked;
  const bool few =
      static_cast<double>(points.size()) < std::max(4.0, options_.min_points * static_cast<double>(count));
  window.outcome = points.empty()           ? WindowOutcome::NoLattice
                   : few                    ? WindowOutcome::TooFewInGrid
                   : points.size() == count ? WindowOutcome::Complete
                                            : WindowOutcome::Partial;
  if (few) window.circles = 0;
  if (!few) seen_.push_back({time, std::move(points), windows_.size()});
  windows_.push_back(window);
}

void FrameTracker::skipUnreadable(const FrameTime& time) {
  WindowReport window;
  window.time_s = time.time_s;
  window.outcome = WindowOutcome::Unreadable;
  windows_.push_back(window);
}

BoardObservations FrameTracker::finish() {
  std::vector<PointsInFrame> frames;
  for (Seen& seen : seen_) frames.push_back({seen.time.time_s, seen.time.exposure_s, std::move(seen.points)});
  BoardObservations observations;
  observations.camera = camera_;
  std::vector<ViewFromFrame> views = viewsFromFrames(frames, board_.pointCount());
  for (std::size_t k = 0; k < views.size(); ++k) {
    if (views[k].speed_px_s * frames[k].exposure_s > options_.max_blur_px) {
      windows_[seen_[k].window].outcome = WindowOutcome::Blurred;
      windows_[seen_[k].window].circles = 0;
    } else {
      observations.views.push_back(std::move(views[k].view));
    }
  }
  observations.windows = std::exchange(windows_, {});
  seen_.clear();
  return observations;
}

}  // namespace evical
