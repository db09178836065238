// SPDX-License-Identifier: GPL-3.0-or-later
// What the front end makes of one window, with every stage kept and told in words. Pure functions of bursts
// and options, for a worker thread; the front end's own (core/frontend/window_trace.h) do the work.
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

struct WindowAnalysis {
  double time_s = 0.0, half_width_s = 0.0;
  std::shared_ptr<const BoardScene> scene;
  std::optional<WindowTrace> tracked;   // from the view before
  std::vector<BoardSearch> searches;    // in order; one more where the first found nothing
  std::optional<WindowTrace> acquired;  // from what the search found
  FlowAround flow;
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  std::vector<StageReport> stages;
  double took_s = 0.0;

  bool held() const { return tracked && tracked->held(); }
  // Tracked or acquired: that which has the last word. Empty where there is neither.
  const WindowTrace& trace() const;
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
