// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_analysis.h"

#include "core/base/time.h"

#include <algorithm>

namespace evical::ui {
namespace {

std::int64_t middleOf(const WindowQuestion& question) {
  return question.start_ns + nanosecondsFrom(question.time_s);
}

const BoardView* viewBefore(const WindowQuestion& question) {
  if (!question.observations) return nullptr;
  return viewToTrackFrom(*question.observations, question.time_s, question.options.tracking);
}

WindowTrace trackFrom(const BoardMotion& last, const BurstHistory& history, const WindowQuestion& question) {
  BurstWindow window(*question.scene);
  const WindowSlot slot = WindowSlot::around(middleOf(question), question.half_width_s);
  return trackWindow({history, *question.scene, question.options, question.start_ns}, slot, last, window,
                     TraceDetail::Everything);
}

void findFlow(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis) {
  std::optional<double> half_window_s;
  for (const BoardSearch& search : analysis.searches) {
    if (search.source == CandidateSource::NormalFlow) half_window_s = search.half_window_s;
  }
  if (half_window_s == analysis.flow.half_window_s) return;
  if (!half_window_s && analysis.flow.half_window_s > 0.0) return;
  analysis.flow = flowAround(history, middleOf(question), half_window_s, *question.scene, question.options);
}

}  // namespace

TimeSpan neededBursts_s(const WindowQuestion& question) {
  const double fit_s = question.options.tracking.max_fit_half_window_s;
  const double reach_s = std::max({kSearchReach_s, question.half_width_s, fit_s});
  const BoardView* view = viewBefore(question);
  const double begin_s = question.time_s - reach_s;
  return {view ? std::min(begin_s, view->time_s - fit_s) : begin_s, question.time_s + reach_s};
}

const WindowTrace& WindowAnalysis::trace() const {
  static const WindowTrace kNone;
  if (held() || !acquired) return tracked ? *tracked : kNone;
  return *acquired;
}

const BoardSearch* WindowAnalysis::bestSearch() const {
  const auto less = [](const BoardSearch& a, const BoardSearch& b) { return a.ended < b.ended; };
  const auto best = std::max_element(searches.begin(), searches.end(), less);
  return best == searches.end() ? nullptr : &*best;
}

WindowAnalysis analyseTracking(const BurstHistory& history, const WindowQuestion& question) {
  const Stopwatch stopwatch;
  WindowAnalysis analysis;
  analysis.time_s = question.time_s;
  analysis.half_width_s = question.half_width_s;
  analysis.scene = question.scene;
  if (const BoardView* const view = viewBefore(question)) {
    const auto last = motionAtView({history, *question.scene, question.options, question.start_ns}, *view);
    if (last) analysis.tracked = trackFrom(*last, history, question);
  }
  if (analysis.tracked) analysis.outcome = analysis.tracked->report.outcome;
  if (question.flow) findFlow(history, question, analysis);
  analysis.stages = describeStages(analysis, question.options);
  analysis.took_s = stopwatch.elapsed_s();
  return analysis;
}

void addSearch(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis) {
  const Stopwatch stopwatch;
  analysis.searches = searchBoard(history, middleOf(question), *question.scene, question.options);
  if (!analysis.held()) {
    const BoardSearch& best = *analysis.bestSearch();
    if (best.motion) analysis.acquired = trackFrom(*best.motion, history, question);
    analysis.outcome = analysis.acquired ? analysis.acquired->report.outcome : best.outcome;
  }
  if (question.flow) findFlow(history, question, analysis);
  analysis.stages = describeStages(analysis, question.options);
  analysis.took_s += stopwatch.elapsed_s();
}

}  // namespace evical::ui
