// The tracker's result for one window, as a function of its inputs. The tracker continues from it; drawings
// show its last stage and the reason.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/circle_measurement.h"
#include "core/frontend/detection_options.h"

#include "core/data/board_observations.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

// The time interval of a window: neighbours do not overlap.
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

// Smallest share of the expected circles in a tracked board from which tracking continues.
inline constexpr double kMinExpected = 0.5, kMinExpectedForSingleEvents = 0.25;

enum class TrackingEnd {
  NoFit,             // too few bursts at expected edges
  TooFewCircles,     // fewer than a grid needs
  TooFewOfExpected,  // too small a share of the expected ones
  Held,              // good enough to continue from
};

struct WindowTrace {
  WindowReport report;
  std::int64_t predicted_from_ns = 0;
  BoardMotion prediction;
  std::optional<BoardMotion> motion;  // fitted
  TrackingEnd ended = TrackingEnd::NoFit;
  int expected = 0;  // number of circles that should be visible
  std::vector<CircleObservation> circles;
  MeasurementTrace measurement;  // if requested

  bool held() const { return ended == TrackingEnd::Held; }
};

// Smallest number of points of a partial view of a board with `count` of them.
double minPartial(int count, const GridOptions& options);

// Outcome of a tracked window with this number of circles.
WindowOutcome outcomeOf(int found, const BoardScene& scene, const GridOptions& options);

enum class TraceDetail { Result, Everything };

// Tracks the board from its motion at another time, or at the slot's middle. Afterwards `window` contains the
// bursts of the slot.
WindowTrace trackWindow(const TrackingInput& input, const WindowSlot& slot, const BoardMotion& last,
                        BurstWindow& window, TraceDetail detail = TraceDetail::Result);

// The last view before that time from which the tracker would still continue; null if there is none.
const BoardView* viewToTrackFrom(const BoardObservations& observations, double time_s,
                                 const TrackingOptions& options);

// The board's motion at a view. Views store less than the tracker does, so the motion is fitted again to the
// bursts around it.
std::optional<BoardMotion> motionAtView(const TrackingInput& input, const BoardView& view);

// Observer of the front end, for drawings and live views.

class BurstWindow;
struct BoardSearch;
struct WindowTrace;

// Receives every window when it is processed. Called from the thread that adds events.
class FrontEndObserver {
 public:
  virtual ~FrontEndObserver() = default;
  virtual void windowTracked(const BurstWindow& window, const WindowTrace& trace) = 0;
  virtual void windowSearched(const BoardSearch& search, std::int64_t middle_ns) = 0;
};

}  // namespace evical
