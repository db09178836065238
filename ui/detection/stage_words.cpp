// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_analysis.h"

#include "core/numerics/robust.h"

#include <cmath>
#include <cstdio>

namespace evical::ui {
namespace {

template <class... Values>
std::string print(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// The stage at which a search with this outcome ended, counted as in searchStages.
int lostAt(const BoardSearch& search) {
  switch (search.outcome) {
    case WindowOutcome::TooFewEvents:
      return 0;
    case WindowOutcome::TooFewCircles:
      return 2;
    case WindowOutcome::NoLattice:
      return search.lattice.size() < 4 ? 3 : 4;
    case WindowOutcome::TooFewInGrid:
      return search.placements.empty() ? 3 : 5;
    case WindowOutcome::Ambiguous:
    case WindowOutcome::RefinementFailed:
      return 5;
    case WindowOutcome::Complete:
    case WindowOutcome::Partial:
      break;
  }
  return 6;
}

std::string candidateText(const SourceSearch& source, const WindowAnalysis& analysis) {
  const int candidates = static_cast<int>(source.search.candidates.size());
  if (source.source != CandidateSource::NormalFlow || analysis.arcs.flow.empty())
    return print("%d by %s", candidates, sourceName(source.source));
  int kinds[3] = {0, 0, 0};
  for (const EventCluster& cluster : analysis.arcs.clusters) ++kinds[static_cast<int>(cluster.kind)];
  return print("%d by normal flow: %zu flow vectors in %zu clusters (%d run, %d chase, %d other), %zu pairs",
               candidates, analysis.arcs.flow.size(), analysis.arcs.clusters.size(), kinds[0], kinds[1],
               kinds[2], analysis.arcs.pairs.size());
}

std::string placementText(const BoardSearch& search) {
  if (search.placements.empty()) return "no way to lay the lattice on the board that a camera could see";
  return print("%zu ways to lay the lattice on the board, the best with %zu circles",
               search.placements.size(), search.placements.front().circles.size());
}

std::string jointText(const BoardSearch& search, const WindowAnalysis& analysis, const GridOptions& options) {
  const int count = analysis.scene->board.circleCount();
  switch (search.outcome) {
    case WindowOutcome::Ambiguous:
      return print("another placement explains nearly as many circles (ambiguity_margin is %d)",
                   options.ambiguity_margin);
    case WindowOutcome::RefinementFailed:
      return "no placement holds when all circles are fitted together";
    case WindowOutcome::TooFewInGrid:
      return print(
          "too few of the %d circles are confirmed, or too many that should be seen are not (%.0f %% "
          "needed, most_missing is %.2f)",
          count, 100.0 * options.least_partial, options.most_missing);
    default:
      break;
  }
  return search.motion
             ? print("%.2f px RMS over %d bursts", search.motion->residual_rms_px, search.motion->bursts)
             : std::string();
}

void addSearch(const SourceSearch& source, const WindowAnalysis& analysis, const FrontEndOptions& options,
               std::vector<StageReport>& stages) {
  const BoardSearch& search = source.search;
  const int lost = lostAt(search);
  const auto add = [&](int stage, const char* name, const std::string& text) {
    const StageVerdict verdict = stage < lost    ? StageVerdict::Passed
                                 : stage == lost ? StageVerdict::Failed
                                                 : StageVerdict::NotReached;
    stages.push_back({name, verdict, verdict == StageVerdict::NotReached ? "not reached" : text});
  };
  add(0, "edge bursts",
      print("%d within \u00b1%.1f ms (at least %d needed)", search.bursts, 1e3 * search.half_window_s,
            options.detection.least_window_bursts));
  add(1, "candidates", candidateText(source, analysis));
  add(2, "moving circles",
      print("%zu of %zu candidates are circles that move (at least %d needed)", search.circles.size(),
            search.candidates.size(), options.grid.least_circles));
  add(3, "lattice",
      print("%zu circles in one lattice (at least %d needed)", search.lattice.size(),
            options.grid.least_circles));
  add(4, "placement", placementText(search));
  add(5, "joint fit", jointText(search, analysis, options.grid));
}

void addTracking(const WindowAnalysis& analysis, std::vector<StageReport>& stages) {
  if (!analysis.prediction && analysis.tracked) {
    stages.push_back({"prediction", StageVerdict::Passed, "from the window before: holds"});
    return;
  }
  if (!analysis.prediction) {
    stages.push_back({"prediction", StageVerdict::Note, "none: no view of the board shortly before"});
    return;
  }
  const std::string from =
      print("from the view %.1f ms before: ", 1e3 * (analysis.time_s - analysis.predicted_from_s));
  if (analysis.tracked) {
    stages.push_back({"prediction", StageVerdict::Passed,
                      from + print("holds, %.2f px RMS over %d bursts", analysis.motion->residual_rms_px,
                                   analysis.motion->bursts)});
  } else {
    stages.push_back({"prediction", StageVerdict::Failed, from + "too few circles where it says"});
  }
}

// The numbers of circles without a centre, as long as they are few.
std::string missingText(const WindowAnalysis& analysis) {
  const int count = analysis.scene->board.circleCount();
  constexpr int kMostNamed = 10;
  const int missing = count - static_cast<int>(analysis.circles.size());
  if (missing < 1 || missing > kMostNamed) return {};
  std::vector<bool> found(static_cast<std::size_t>(count), false);
  for (const CircleObservation& circle : analysis.circles)
    found[static_cast<std::size_t>(circle.circle)] = true;
  std::string text = ", without";
  for (int circle = 0; circle < count; ++circle) {
    if (!found[static_cast<std::size_t>(circle)]) text += print(" %d", circle);
  }
  return text;
}

void addCentres(const WindowAnalysis& analysis, std::vector<StageReport>& stages) {
  const int count = analysis.scene->board.circleCount();
  if (!analysis.motion) {
    stages.push_back({"centres", StageVerdict::NotReached, "not reached"});
    return;
  }
  std::vector<double> sigmas;
  for (const CircleObservation& circle : analysis.circles)
    sigmas.push_back(std::sqrt(0.5 * circle.covariance_px2.trace()));
  std::string text = print("%zu of %d circles measured", analysis.circles.size(), count);
  if (!sigmas.empty()) text += print(", sigma %.3f px", medianOf(std::move(sigmas)));
  text += missingText(analysis);
  const bool good = analysis.outcome == WindowOutcome::Complete || analysis.outcome == WindowOutcome::Partial;
  stages.push_back({"centres", good ? StageVerdict::Passed : StageVerdict::Failed, text});
}

}  // namespace

const char* sourceName(CandidateSource source) {
  return source == CandidateSource::RingVote ? "ring vote" : "normal flow";
}

std::vector<StageReport> describeStages(const WindowAnalysis& analysis, const FrontEndOptions& options) {
  std::vector<StageReport> stages;
  addTracking(analysis, stages);
  const SourceSearch* best = analysis.bestSearch();
  if (best) addSearch(*best, analysis, options, stages);
  for (const SourceSearch& source : analysis.searches) {
    if (&source == best) continue;
    stages.push_back({sourceName(source.source), StageVerdict::Note,
                      std::string("tried too: ") + windowOutcomeName(source.search.outcome)});
  }
  addCentres(analysis, stages);
  return stages;
}

}  // namespace evical::ui
