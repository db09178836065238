// The tracker's result for one window, as a function of its inputs. The tracker continues from it; drawings
// show its last stage and the reason.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/board_motion.h"
#include "core/frontend/circle_measurement.h"
#include "core/frontend/front_end_options.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

// A window's own time: neighbours do not overlap.
struct WindowSlot {
  std::int64_t begin_ns = 0, end_ns = 0;

  static WindowSlot around(std::int64_t middle_ns, double half_s);
  std::int64_t middle_ns() const { return begin_ns + (end_ns - begin_ns) / 2; }
  double half_s() const { return 0.5e-9 * static_cast<double>(end_ns - begin_ns); }
};

// Common data of all windows of a recording.
struct TrackingInput {
  const BurstHistory& history;
  const BoardScene& scene;
  const FrontEndOptions& options;
  std::int64_t start_ns = 0;  // zero of the times in seconds
};

// Part of the circles that should be seen which must be, for a tracked board to be gone on from.
inline constexpr double kLeastExpected = 0.5;

enum class TrackingEnd {
  NoFit,             // too few bursts where edges should be
  TooFewCircles,     // than make a grid
  TooFewOfExpected,  // of those that should be seen
  Held,              // good enough to continue from
};

struct WindowTrace {
  WindowReport report;
  std::int64_t predicted_from_ns = 0;
  BoardMotion prediction;
  std::optional<BoardMotion> motion;  // fitted
  TrackingEnd ended = TrackingEnd::NoFit;
  int expected = 0;  // circles that should be seen
  std::vector<CircleObservation> circles;
  MeasurementTrace measurement;  // where asked for

  bool held() const { return ended == TrackingEnd::Held; }
};

// Outcome of a tracked window with so many circles.
WindowOutcome outcomeOf(int found, const BoardScene& scene, const GridOptions& options);

enum class TraceDetail { Result, Everything };

// Tracks the board from its motion at another time, or at the slot's middle. `window` is left with the bursts
// that were looked at.
WindowTrace trackWindow(const TrackingInput& input, const WindowSlot& slot, const BoardMotion& last,
                        BurstWindow& window, TraceDetail detail = TraceDetail::Result);

// The last view before that time from which the tracker would still continue; null if there is none.
const BoardView* viewToTrackFrom(const BoardObservations& observations, double time_s,
                                 const TrackingOptions& options);

// The board's motion at a view. Views keep less of it than the tracker does, so it is fitted once
// more to the bursts around.
std::optional<BoardMotion> motionAtView(const TrackingInput& input, const BoardView& view);

}  // namespace evical
