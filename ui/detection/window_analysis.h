// SPDX-License-Identifier: GPL-3.0-or-later
// What the front end makes of one window of events or of one frame, with every stage kept and told in words. Pure
// functions of bursts and options, for a worker thread; the front end's own (core/frontend/window_trace.h) do the work.
#pragma once

#include "core/frontend/board_scene.h"
#include "core/frontend/board_search.h"
#include "core/frontend/window_trace.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evical::ui {

struct WindowQuestion {
  std::int64_t start_ns = 0;   // the recording's
  double time_s = 0.0;         // middle, since then
  double half_width_s = 0.01;  // bursts that measure centres; searches choose their own
  bool flow = true;            // with normal flow, clusters and pairs, for drawing
  std::shared_ptr<const BoardScene> scene;
  FrontEndOptions options;
  std::shared_ptr<const BoardObservations> observations;  // to track from; may be null
};

// Which bursts have a say in a window.
struct TimeSpan {
  double begin_s, end_s;
};
TimeSpan neededBursts_s(const WindowQuestion& question);

enum class StageVerdict { Passed, Failed, NotReached, Note };
struct StageReport {
  std::string stage;  // "moving circles"
  StageVerdict verdict = StageVerdict::Note;
  std::string text;  // numbers, and why it failed
};

// What was found in a frame, where that is what is looked at.
struct FrameFinding {
  std::size_t number = 0, count = 0;        // from 1 on; of the frames read so far
  Resolution size_px;                       // unknown where it cannot be decoded
  double exposure_s = 0.0;                  // 0: not known
  bool due = true;                          // at the rate that is asked for
  bool settled = true;                      // no second look is under way
  bool tracked = false;                     // followed from the frames before instead of found in all of it
  double blur_px = 0.0;                     // how far the board moves while the frame is exposed
  double darkest = 0.0, brightest = 255.0;  // 5th and 95th percentile of its pixels
  std::vector<CircleObservation> points;    // in the sensor's own pixels; also those of no use
  std::string problem;                      // why it cannot be read
  std::string doubt;                        // what speaks against the board's numbers
};

struct WindowAnalysis {
  double time_s = 0.0, half_width_s = 0.0;
  std::shared_ptr<const BoardScene> scene;
  std::optional<WindowTrace> tracked;   // from the view before
  std::vector<BoardSearch> searches;    // in order; one more where the first found nothing
  std::optional<WindowTrace> acquired;  // from what the search found
  FlowAround flow;
  std::optional<FrameFinding> frame;
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  std::vector<StageReport> stages;
  double took_s = 0.0;

  bool held() const { return tracked && tracked->held(); }
  // Tracked or acquired: that which has the last word. Empty where there is neither.
  const WindowTrace& trace() const;
  // The board's points that were found, of either kind.
  const std::vector<CircleObservation>& points() const { return frame ? frame->points : trace().circles; }
  // The one that tells most: that which found the board, or else got furthest. Null if none was made.
  const BoardSearch* bestSearch() const;
};

// What is known at once: the prediction from the view before, the board tracked from it, and normal flow.
WindowAnalysis analyseTracking(const BurstHistory& history, const WindowQuestion& question);
// Then the search from nothing, which takes longer; it has the last word where tracking failed.
void addSearch(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis);

// In the order in which the front end goes through them.
std::vector<StageReport> describeStages(const WindowAnalysis& analysis, const FrontEndOptions& options);

}  // namespace evical::ui
