// SPDX-License-Identifier: GPL-3.0-or-later
// The front end's chain on one window, with every stage kept: what it saw, what it made of it, and where it
// gave up. Pure functions of bursts and options, for a worker thread.
#pragma once

#include "core/frontend/board_search.h"
#include "core/frontend/circle_pairs.h"

#include <Eigen/Core>

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

// One search, by one source of candidates.
struct SourceSearch {
  CandidateSource source = CandidateSource::NormalFlow;
  BoardSearch search;
};

enum class StageVerdict { Passed, Failed, NotReached, Note };
struct StageReport {
  std::string stage;  // "moving circles"
  StageVerdict verdict = StageVerdict::Note;
  std::string text;  // numbers, and why it failed
};

// A burst on the edge of a measured circle.
struct EdgeInlier {
  Eigen::Vector2f pixel;
  bool leading;
};

struct WindowAnalysis {
  double time_s = 0.0, half_width_s = 0.0;
  std::shared_ptr<const BoardScene> scene;
  std::vector<SourceSearch> searches;  // in order; one more where the first found nothing
  NormalFlowStages arcs;
  double arcs_half_width_s = 0.0;
  std::optional<BoardMotion> prediction;  // from the view before
  double predicted_from_s = 0.0;
  std::optional<BoardMotion> motion;  // of the board, fitted
  bool tracked = false;               // from the prediction, not from a search
  std::vector<CircleObservation> circles;
  std::vector<EdgeInlier> inliers;
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  std::vector<StageReport> stages;
  double took_s = 0.0;

  // The one that tells most: that which found the board, or else got furthest. Null if none was made.
  const SourceSearch* bestSearch() const;
};

// What is known at once: the prediction from the view before, the board tracked from it, and normal flow.
WindowAnalysis trackWindow(const BurstHistory& history, const WindowQuestion& question);
// Then the search from nothing, which takes longer; it has the last word where tracking failed.
void searchWindow(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis);

// In the order in which the front end goes through them.
std::vector<StageReport> describeStages(const WindowAnalysis& analysis, const FrontEndOptions& options);

const char* sourceName(CandidateSource source);

}  // namespace evical::ui
