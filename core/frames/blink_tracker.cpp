#include "core/frames/blink_tracker.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/frames/views_from_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace evical {
namespace {

constexpr double kLargestBlur_px = 1.0;  // motion within the shortest part of a slot

double middle_s(const FlashCounts& counts, std::int64_t start_ns) {
  return 0.5 * (secondsSince(start_ns, counts.begin_ns) + secondsSince(start_ns, counts.end_ns));
}

double nearestNeighbours_px(const FoundPoints& points) {
  double nearest_px = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      nearest_px = std::min(nearest_px, (points[k].at_px - points[j].at_px).norm());
  return nearest_px;
}

FlashCounts sumOfMiddle(const FlashSlot& slot, std::size_t parts) {
  return sumOf(std::span(slot).subspan((slot.size() - parts) / 2, parts));
}

}  // namespace

BlinkTracker::BlinkTracker(std::string camera, const Board& board, Resolution resolution_px,
                           const FrameOptions& frames, const BlinkOptions& options, std::int64_t start_ns)
    : camera_(std::move(camera)),
      board_(board),
      resolution_px_(resolution_px),
      frames_(frames),
      options_(options),
      start_ns_(start_ns),
      notice_(resolution_px, options),
      finder_(board, resolution_px, frames, options) {
  so_far_.camera = camera_;
}

void BlinkTracker::add(EventSpan events) {
  if (gathering_) return gather(events);
  notice_.add(events);
  if (!notice_.blink()) return;
  gathering_.emplace(resolution_px_, notice_.blink()->period_s, 1.0 / frames_.rate_hz,
                     [this](const FlashSlot& slot) { see(slot); });
  gather(notice_.takeEvents());
}

void BlinkTracker::gather(EventSpan events) {
  for (const Event& event : events) gathering_->add(event);
}

// The board's motion within the slot determines how many flashes may be summed.
void BlinkTracker::see(const FlashSlot& slot) {
  const FlashCounts whole = sumOf(slot);
  WindowReport window;
  window.time_s = middle_s(whole, start_ns_);
  window.half_width_s = 0.5 * secondsSince(whole.begin_ns, whole.end_ns);
  window.outcome = WindowOutcome::TooFewEvents;
  if (flashingPixels(whole) < static_cast<std::size_t>(board_.pointCount())) {
    so_far_.windows.push_back(window);
    return;
  }
  window.outcome = WindowOutcome::NoLattice;
  FoundPoints found = follow(whole, window.time_s);
  window.tracked = !found.empty();
  if (found.empty()) found = finder_.find(whole);
  if (found.empty() && slot.size() > 1) found = finder_.find(sumOfMiddle(slot, 1));
  if (finder_.renumbered()) dropEarlier();
  if (!window.tracked) searched_points_ = found.size();
  max_points_ = std::max(max_points_, searched_points_);
  if (!found.empty() && slot.size() > 1) found = withoutMotion(slot, std::move(found), window);
  keep(std::move(found), window);
}

// Measures the board near its last place: ten times faster than a search. Empty if this does not find nearly
// all points, or if the last search found fewer points than others.
FoundPoints BlinkTracker::follow(const FlashCounts& whole, double time_s) {
  constexpr double kLongestGap_s = 0.5, kNearlyAll = 0.9, kToNeighbours = 0.4;
  const bool search = seen_.empty() || time_s - seen_.back().time_s > kLongestGap_s ||
                      searched_points_ < max_points_ || followed_++ >= frames_.search_every_frames;
  FoundPoints found;
  if (!search) {
    const FoundPoints& last = seen_.back().points;
    found = finder_.measure(whole, last,
                            std::min(frames_.prediction_gate_px, kToNeighbours * nearestNeighbours_px(last)));
    if (static_cast<double>(found.size()) >= kNearlyAll * static_cast<double>(searched_points_)) return found;
  }
  followed_ = 0;
  return {};
}

FoundPoints BlinkTracker::withoutMotion(const FlashSlot& slot, FoundPoints found,
                                        WindowReport& window) const {
  const std::size_t half = slot.size() / 2;
  const double gate_px = frames_.prediction_gate_px;
  const FlashCounts before = sumOf(std::span(slot).first(half)), after = sumOf(std::span(slot).last(half));
  const std::optional<double> moved =
      movement_px(finder_.measure(before, found, gate_px), finder_.measure(after, found, gate_px));
  const double between_s = middle_s(after, start_ns_) - middle_s(before, start_ns_);
  const double moves_px = moved ? *moved * 2.0 * window.half_width_s / between_s : 0.0;
  if (moved && moves_px <= options_.max_move_px) return found;
  const auto all = static_cast<double>(slot.size());
  if (moves_px > kLargestBlur_px * all) {
    window.outcome = WindowOutcome::Blurred;
    return {};
  }
  const auto parts =
      moved ? std::max<std::size_t>(1, static_cast<std::size_t>(all * options_.max_move_px / moves_px)) : 1;
  const FlashCounts sum = sumOfMiddle(slot, std::min(parts, slot.size()));
  window.time_s = middle_s(sum, start_ns_);
  window.half_width_s = 0.5 * secondsSince(sum.begin_ns, sum.end_ns);
  return finder_.measure(sum, found, gate_px);
}

// Views whose points have wrong numbers.
void BlinkTracker::dropEarlier() {
  for (WindowReport& window : so_far_.windows) {
    if (window.circles == 0) continue;
    window.outcome = WindowOutcome::Ambiguous;
    window.circles = 0;
  }
  seen_.clear();
}

void BlinkTracker::keep(FoundPoints points, WindowReport window) {
  const auto all = static_cast<std::size_t>(board_.pointCount());
  window.candidates = static_cast<int>(points.size());
  const bool few =
      static_cast<double>(points.size()) < std::max(4.0, frames_.min_points * static_cast<double>(all));
  if (!points.empty())
    window.outcome = few                    ? WindowOutcome::TooFewInGrid
                     : points.size() == all ? WindowOutcome::Complete
                                            : WindowOutcome::Partial;
  if (!few) {
    window.circles = window.candidates;
    seen_.push_back({window.time_s, 0.0, std::move(points)});
  }
  so_far_.windows.push_back(window);
}

BoardObservations BlinkTracker::finish() {
  if (!gathering_) {
    notice_.finish();
    add({});
  }
  if (!gathering_) {
    const Blink& clearest = notice_.clearest();
    throw calibrationFailed(
        camera_,
        clearest.peak > 0.0 ? fmt::format("no blinking board detected: the clearest rhythm, of {:.0f} Hz, "
                                          "has a correlation of {:.2f} "
                                          "and {:.0f} % of "
                                          "the events, but {:.2f} and {:.0f} % are required",
                                          1.0 / clearest.period_s, clearest.peak, 100.0 * clearest.share,
                                          options_.min_peak, 100.0 * options_.min_share)
                            : fmt::format("no blinking between {:.0f} and {:.0f} Hz detected",
                                          options_.min_hz, options_.max_hz),
        "Check that the screen flashes (a page that flashes is made " + howTo(HowTo::MakeFlashingPage) +
            "), that it fills a large part of the image, and that the camera is at rest. For a board that "
            "does not "
            "flash, remove "
            "that setting from the session, and move the camera");
  }
  gathering_->finish();
  const std::vector<PointsInFrame> views = joinedWhileStill(seen_, options_.still_px, frames_.min_sigma_px);
  for (ViewFromFrame& view : viewsFromFrames(views, board_.pointCount()))
    so_far_.views.push_back(std::move(view.view));
  seen_.clear();
  return std::exchange(so_far_, {});
}

}  // namespace evical
