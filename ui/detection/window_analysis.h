// SPDX-License-Identifier: GPL-3.0-or-later
// The front end's stages on one window of events or one frame, with descriptions. Pure functions of bursts
// and options, for a worker thread; the work is done by functions of the front end
// (core/frontend/window_trace.h).
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
  std::int64_t start_ns = 0;   // start of the recording
  double time_s = 0.0;         // middle, since the start
  double half_width_s = 0.01;  // bursts that measure centres; searches choose their own
  bool flow = true;            // with normal flow, clusters and pairs, for drawing
  std::shared_ptr<const BoardScene> scene;
  FrontEndOptions options;
  std::shared_ptr<const BoardObservations> observations;  // to track from; may be null
};

// Time span of the bursts that affect a window.
struct TimeSpan {
  double begin_s, end_s;
};
TimeSpan neededBursts_s(const WindowQuestion& question);

enum class StageVerdict { Passed, Failed, NotReached, Note };
struct StageReport {
  std::string stage;  // "moving circles"
  StageVerdict verdict = StageVerdict::Note;
  std::string text;  // numbers, and the reason of a failure
};

// Finding in a frame, for frame cameras.
struct FrameFinding {
  std::size_t number = 0, count = 0;        // number from 1 on; count of the frames read until now
  Resolution size_px;                       // unknown if it cannot be decoded
  double exposure_s = 0.0;                  // 0: unknown
  bool due = true;                          // used at the requested rate
  bool settled = true;                      // no second attempt is running
  bool tracked = false;                     // tracked from previous frames instead of found by search
  double blur_px = 0.0;                     // motion of the board during the exposure
  double darkest = 0.0, brightest = 255.0;  // 5th and 95th percentile of its pixels
  std::vector<CircleObservation> points;    // in sensor pixels; also unused ones
  std::string problem;                      // reason why it cannot be read
  std::string doubt;                        // evidence against the board's numbers
  std::string remark;                       // on the print: rotated or renumbered tags
};

struct WindowAnalysis {
  double time_s = 0.0, half_width_s = 0.0;
  std::shared_ptr<const BoardScene> scene;
  std::optional<WindowTrace> tracked;   // from the previous view
  std::vector<BoardSearch> searches;    // in order; a second one if the first found nothing
  std::optional<WindowTrace> acquired;  // from the result of the search
  FlowAround flow;
  std::optional<FrameFinding> frame;
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  std::vector<StageReport> stages;
  double took_s = 0.0;

  bool held() const { return tracked && tracked->held(); }
  // Tracked or acquired: the one that decides. Empty if there is neither.
  const WindowTrace& trace() const;
  // The found points of the board, in events or frames.
  const std::vector<CircleObservation>& points() const { return frame ? frame->points : trace().circles; }
  // The most informative search: the one that found the board, or else got furthest. Null if there was none.
  const BoardSearch* bestSearch() const;
};

// Fast part: prediction from the previous view, tracking of the board, and normal flow.
WindowAnalysis analyseTracking(const BurstHistory& history, const WindowQuestion& question);
// Slower part: the search without prediction, which decides if tracking failed.
void addSearch(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis);

// In the order of the front end.
std::vector<StageReport> describeStages(const WindowAnalysis& analysis, const FrontEndOptions& options);

}  // namespace evical::ui
