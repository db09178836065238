#include "core/frontend/window_trace.h"

#include "core/base/time.h"
#include "core/frontend/board_motion.h"
#include "core/frontend/board_placement.h"
#include "core/frontend/pattern_agreement.h"
#include "core/geometry/homography.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace evical {
namespace {

// Predictions across windows without the board are less accurate: their first gate is wider.
constexpr double kLostGateFactor = 2.0;
// Bursts are gathered in a wider window than the predicted speed requires: the fit may find a slower board.
constexpr double kFitReach = 1.5;

double fitReach_s(const BoardMotion& prediction, const BoardScene& scene, const TrackingOptions& options) {
  return std::min(kFitReach * fitHalfWindow_s(boardSpeed_px_s(prediction, scene), options),
                  options.max_fit_half_window_s);
}

double firstGate_px(const BoardMotion& last, const WindowSlot& slot, const FrontEndOptions& options) {
  const bool lost = last.time_ns < slot.begin_ns - nanosecondsFrom(2.0 * options.detection.max_window_s);
  return options.tracking.first_gate_px * (lost ? kLostGateFactor : 1.0);
}

TrackingEnd endOf(int found, int expected, bool single_events, const FrontEndOptions& options) {
  if (found < options.grid.min_circles) return TrackingEnd::TooFewCircles;
  if (found < (single_events ? kMinExpectedForSingleEvents : kMinExpected) * expected)
    return TrackingEnd::TooFewOfExpected;
  return TrackingEnd::Held;
}

// Moves a board of squares back if it slid along its edges since its last window. False if the crossings
// contradict its place.
bool holdsInPlace(const BurstWindow& window, const BoardScene& scene, const WindowSlot& slot,
                  const BoardMotion& last, const TrackingOptions& options, BoardMotion& motion) {
  if (!scene.edges || scene.single_events) return true;
  SlideCheck check = checkSlide(motion, window, scene, slot.half_s());
  if (!check.moved) return !check.contradicted;
  BoardMotion& moved = *check.moved;
  const double since_s = static_cast<double>(motion.time_ns - last.time_ns) * 1e-9;
  if (std::abs(since_s) > slot.half_s()) {
    const Eigen::Vector3d middle = (0.5 * scene.board.extent_m() + scene.board.corner_m()).homogeneous();
    const Eigen::Vector2d slide_px =
        (moved.ideal_from_board * middle).hnormalized() - (motion.ideal_from_board * middle).hnormalized();
    moved.velocity_px_s(0) += slide_px.x() / since_s;
    moved.velocity_px_s(3) += slide_px.y() / since_s;
  }
  const std::optional<BoardMotion> fitted =
      fitBoardMotion(window, moved, scene, options.last_gate_px, options);
  motion = fitted.value_or(moved);
  return !check.contradicted;
}

}  // namespace

double minPartial(int count, const GridOptions& options) {
  constexpr int kMany = 50;  // of a board with more points, a smaller share determines its pose as well
  return std::max<double>(kMinForHomography, options.min_partial * std::min(count, kMany));
}

WindowOutcome outcomeOf(int found, const BoardScene& scene, const GridOptions& options) {
  const int count = scene.board.pointCount();
  const double least = minPartial(count, options);
  if (found < least) return WindowOutcome::TooFewInGrid;
  return found == count ? WindowOutcome::Complete : WindowOutcome::Partial;
}

WindowSlot WindowSlot::around(std::int64_t middle_ns, double half_s) {
  const auto length_ns = static_cast<std::int64_t>(std::llround(2e9 * half_s));
  const std::int64_t begin_ns = middle_ns - length_ns / 2;
  return {begin_ns, begin_ns + length_ns};
}

WindowTrace trackWindow(const TrackingInput& input, const WindowSlot& slot, const BoardMotion& last,
                        BurstWindow& window, TraceDetail detail) {
  const BoardScene& scene = input.scene;
  const TrackingOptions& options = input.options.tracking;
  const std::int64_t middle_ns = slot.middle_ns();
  WindowTrace trace;
  trace.predicted_from_ns = last.time_ns;
  trace.prediction = last.time_ns == middle_ns ? last : predicted(last, middle_ns);
  window.fill(input.history, middle_ns,
              std::max(fitReach_s(trace.prediction, scene, options), slot.half_s()));
  trace.report.time_s = secondsSince(input.start_ns, middle_ns);
  trace.report.half_width_s = slot.half_s();
  trace.report.events = static_cast<int>(window.bursts().size());
  trace.report.tracked = true;
  trace.report.outcome = WindowOutcome::RefinementFailed;
  trace.motion =
      fitBoardMotion(window, trace.prediction, scene, firstGate_px(last, slot, input.options), options);
  if (!trace.motion || !holdsInPlace(window, scene, slot, last, options, *trace.motion)) return trace;
  trace.circles = measureCircles(window, *trace.motion, scene, {slot.half_s(), input.start_ns}, options,
                                 detail == TraceDetail::Everything ? &trace.measurement : nullptr);
  trace.report.circles = static_cast<int>(trace.circles.size());
  trace.expected = expectedCircles(*trace.motion, scene, slot.half_s());
  trace.ended = endOf(trace.report.circles, trace.expected, scene.single_events, input.options);
  if (trace.held()) trace.report.outcome = outcomeOf(trace.report.circles, scene, input.options.grid);
  return trace;
}

const BoardView* viewToTrackFrom(const BoardObservations& observations, double time_s,
                                 const TrackingOptions& options) {
  constexpr double kSame_s = 1e-6;
  const auto before = [](const BoardView& view, double at_s) { return view.time_s < at_s; };
  const auto next =
      std::lower_bound(observations.views.begin(), observations.views.end(), time_s - kSame_s, before);
  if (next == observations.views.begin()) return nullptr;
  const BoardView& view = *std::prev(next);
  return time_s - view.time_s > options.max_gap_s ? nullptr : &view;
}

std::optional<BoardMotion> motionAtView(const TrackingInput& input, const BoardView& view) {
  const TrackingOptions& options = input.options.tracking;
  std::vector<Eigen::Vector2d> on_board, in_image;
  std::vector<MovingPoint> points;
  for (const CircleObservation& circle : view.circles) {
    on_board.push_back(input.scene.board.point_m(circle.circle));
    in_image.push_back(circle.centre_px + (view.time_s - circle.time_s) * circle.velocity_px_s);
    points.push_back({in_image.back(), circle.velocity_px_s});
  }
  const std::optional<Eigen::Matrix3d> homography = fitHomography(on_board, in_image);
  if (!homography) return std::nullopt;
  const BoardMotion rough =
      motionFromPoints(*homography, points, input.start_ns + nanosecondsFrom(view.time_s));
  BurstWindow window(input.scene);
  window.fill(input.history, rough.time_ns, fitReach_s(rough, input.scene, options));
  const std::optional<BoardMotion> motion =
      fitBoardMotion(window, rough, input.scene, options.first_gate_px, options);
  return motion ? motion : rough;
}

}  // namespace evical
