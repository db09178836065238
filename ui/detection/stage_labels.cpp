// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/stage_labels.h"
#include "ui/detection/frame_analysis.h"
#include "ui/detection/timeline.h"
#include "ui/detection/window_analysis.h"

#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

bool isOfUse(const WindowAnalysis& analysis) {
  return analysis.outcome == WindowOutcome::Complete || analysis.outcome == WindowOutcome::Partial;
}

std::string whichText(const FrameFinding& frame) {
  std::string text = print("%zu of %zu", frame.number, frame.count);
  if (frame.size_px.known()) text += print(", %d x %d px", frame.size_px.width_px, frame.size_px.height_px);
  return text + (frame.exposure_s > 0.0 ? print(", exposed for %.2f ms", 1e3 * frame.exposure_s)
                                        : std::string(", exposure unknown"));
}

StageReport pictureStage(const WindowAnalysis& analysis, const FrameOptions& options) {
  const FrameFinding& frame = *analysis.frame;
  const double contrast = frame.brightest - frame.darkest;
  const bool pale = !isOfUse(analysis) && contrast < options.min_contrast;
  std::string text =
      print("90 %% of the pixels are between %.0f and %.0f of 255", frame.darkest, frame.brightest);
  if (pale) text += print(": too little contrast (min_contrast is %.0f)", options.min_contrast);
  return {"picture", pale ? StageVerdict::Failed : StageVerdict::Passed, text};
}

StageReport searchStage(const WindowAnalysis& analysis) {
  const FrameFinding& frame = *analysis.frame;
  if (frame.points.empty())
    return {"search", StageVerdict::Failed,
            "no board at the place predicted from previous frames, nor elsewhere in the frame"};
  return {"search", StageVerdict::Passed,
          frame.tracked ? "tracked from previous frames" : "found by a search of the whole frame"};
}

StageReport pointsStage(const WindowAnalysis& analysis, const FrameOptions& options) {
  const std::vector<CircleObservation>& points = analysis.frame->points;
  const int count = analysis.scene->board.pointCount();
  if (points.empty()) return {"points", StageVerdict::NotReached, "not reached"};
  std::string text = print("%zu of %d", points.size(), count);
  if (analysis.outcome == WindowOutcome::TooFewInGrid)
    return {"points", StageVerdict::Failed,
            text + print(": at least %.0f needed (min_points is %.2f)",
                         std::max(4.0, std::ceil(options.min_points * count)), options.min_points)};
  std::vector<double> sigmas_px;
  for (const CircleObservation& point : points)
    sigmas_px.push_back(std::sqrt(0.5 * point.covariance_px2.trace()));
  text += print(", sigma %.3f px", medianOf(std::move(sigmas_px)));
  return {"points", StageVerdict::Passed, text};
}

StageReport blurStage(const WindowAnalysis& analysis, const FrameOptions& options) {
  const FrameFinding& frame = *analysis.frame;
  const bool blurred = analysis.outcome == WindowOutcome::Blurred;
  if (!isOfUse(analysis) && !blurred) return {"blur", StageVerdict::NotReached, "not reached"};
  if (!(frame.exposure_s > 0.0))
    return {"blur", StageVerdict::Note, "unknown: the recording does not contain the exposure"};
  return {"blur", blurred ? StageVerdict::Failed : StageVerdict::Passed,
          print("the board moves %.2f px during the exposure (max_blur_px is %.1f)", frame.blur_px,
                options.max_blur_px)};
}

}  // namespace

std::vector<StageReport> describeFrame(const WindowAnalysis& analysis, const FrameOptions& options) {
  const FrameFinding& frame = *analysis.frame;
  std::vector<StageReport> stages{{"frame", StageVerdict::Note, whichText(frame)}};
  if (!frame.due)
    stages.push_back(
        {"rate", StageVerdict::Note, print("not used by a run (frames.rate_hz is %g)", options.rate_hz)});
  if (!frame.problem.empty()) {
    stages.push_back({frame.size_px.known() ? "board" : "picture", StageVerdict::Failed, frame.problem});
    return stages;
  }
  stages.push_back(pictureStage(analysis, options));
  stages.push_back(searchStage(analysis));
  stages.push_back(pointsStage(analysis, options));
  stages.push_back(blurStage(analysis, options));
  if (!frame.remark.empty()) stages.push_back({"print", StageVerdict::Note, frame.remark});
  if (!frame.doubt.empty()) stages.push_back({"board", StageVerdict::Failed, frame.doubt});
  return stages;
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

const char* sourceName(CandidateSource source) {
  return source == CandidateSource::RingVote ? "ring vote" : "normal flow";
}

const char* pointsName(const Board& board) {
  return board.hasCircles() ? "circles" : "corners";
}

std::string candidateText(const BoardSearch& search, const NormalFlowStages& arcs) {
  const int candidates = static_cast<int>(search.candidates.size());
  if (search.source != CandidateSource::NormalFlow || arcs.flow.empty())
    return print("%d by %s", candidates, sourceName(search.source));
  int kinds[3] = {0, 0, 0};
  for (const EventCluster& cluster : arcs.clusters) ++kinds[static_cast<int>(cluster.kind)];
  return print("%d by normal flow: %zu flow vectors in %zu clusters (%d run, %d chase, %d other), %zu pairs",
               candidates, arcs.flow.size(), arcs.clusters.size(), kinds[0], kinds[1], kinds[2],
               arcs.pairs.size());
}

std::string placementText(const BoardSearch& search, const Board& board) {
  if (search.placements.empty()) return "no placement of the lattice on the board is geometrically possible";
  return print("%zu placements of the lattice on the board, the best with %zu %s", search.placements.size(),
               search.placements.front().circles.size(), pointsName(board));
}

std::string jointText(const BoardSearch& search, const WindowAnalysis& analysis, const GridOptions& options) {
  const int count = analysis.scene->board.pointCount();
  const char* const points = pointsName(analysis.scene->board);
  switch (search.outcome) {
    case WindowOutcome::Ambiguous:
      return print("another placement explains nearly as many %s (ambiguity_margin is %d)", points,
                   options.ambiguity_margin);
    case WindowOutcome::RefinementFailed:
      return print("no placement passes the joint fit of all %s", points);
    case WindowOutcome::OtherPattern:
      return "the tags between the corners are not those of the session";
    case WindowOutcome::TooSmall:
      return print("the narrowest dark lines are %.1f px wide (%.0f px needed)", search.narrowest_px,
                   kMinInk_px);
    case WindowOutcome::TooFewInGrid:
      return print(
          "too few of the %d %s are confirmed, or too many visible ones are missing (%.0f %% "
          "needed, max_missing is %.2f)",
          count, points, 100.0 * options.min_partial, options.max_missing);
    default:
      break;
  }
  return search.motion
             ? print("%.2f px RMS over %d bursts", search.motion->residual_rms_px, search.motion->bursts)
             : std::string();
}

void addSearchStages(const BoardSearch& search, const WindowAnalysis& analysis,
                     const FrontEndOptions& options, std::vector<StageReport>& stages) {
  const auto add = [&](SearchStage stage, const char* name, const std::string& text) {
    const StageVerdict verdict = stage < search.ended    ? StageVerdict::Passed
                                 : stage == search.ended ? StageVerdict::Failed
                                                         : StageVerdict::NotReached;
    stages.push_back({name, verdict, verdict == StageVerdict::NotReached ? "not reached" : text});
  };
  add(SearchStage::Bursts, "edge bursts",
      print("%d within \u00b1%.1f ms (at least %d needed)", search.bursts, 1e3 * search.half_window_s,
            options.detection.min_window_bursts));
  const Board& board = analysis.scene->board;
  if (board.hasCircles()) {
    add(SearchStage::Candidates, "candidates", candidateText(search, analysis.flow.arcs));
    add(SearchStage::Circles, "moving circles",
        print("%zu of %zu candidates are moving circles (at least %d needed)", search.circles.size(),
              search.candidates.size(), options.grid.min_circles));
  } else {
    add(SearchStage::Circles, "corners",
        print("%zu places where two dark and two bright fields meet (at least %d needed)",
              search.saddles.size(), options.grid.min_circles));
  }
  add(SearchStage::Lattice, "lattice",
      print("%zu %s in one lattice (at least %d needed)", search.lattice.size() + search.corners.nodes.size(),
            pointsName(board), options.grid.min_circles));
  add(SearchStage::Placement, "placement", placementText(search, board));
  add(SearchStage::JointFit, "joint fit", jointText(search, analysis, options.grid));
}

std::string trackingText(const WindowTrace& trace, const Board& board, const FrontEndOptions& options) {
  switch (trace.ended) {
    case TrackingEnd::NoFit:
      return "too few bursts at the predicted edges";
    case TrackingEnd::TooFewCircles:
      return print("too few %s at the predicted places: %zu (at least %d needed)", pointsName(board),
                   trace.circles.size(), options.grid.min_circles);
    case TrackingEnd::TooFewOfExpected:
      return print("too few %s at the predicted places: %zu of %d visible ones (%.0f %% needed)",
                   pointsName(board), trace.circles.size(), trace.expected, 100.0 * kMinExpected);
    case TrackingEnd::Held:
      break;
  }
  return print("confirmed, %.2f px RMS over %d bursts", trace.motion->residual_rms_px, trace.motion->bursts);
}

void addTracking(const WindowAnalysis& analysis, const FrontEndOptions& options,
                 std::vector<StageReport>& stages) {
  if (!analysis.tracked) {
    stages.push_back({"prediction", StageVerdict::Note, "none: no recent view of the board"});
    return;
  }
  const WindowTrace& trace = *analysis.tracked;
  const double gap_ms = 1e-6 * static_cast<double>(trace.prediction.time_ns - trace.predicted_from_ns);
  const std::string from = gap_ms == 0.0 ? "from the search: "
                                         : print("from the view %.1f ms %s: ", std::abs(gap_ms),
                                                 gap_ms > 0.0 ? "before" : "after");
  stages.push_back({"prediction", trace.held() ? StageVerdict::Passed : StageVerdict::Failed,
                    from + trackingText(trace, analysis.scene->board, options)});
}

// Numbers of the circles without a centre, and the reasons, unless they are many.
std::string missingText(const WindowTrace& trace, int count) {
  constexpr int kMaxNamed = 10;
  const int missing = count - static_cast<int>(trace.circles.size());
  if (missing < 1 || missing > kMaxNamed) return {};
  std::vector<bool> found(static_cast<std::size_t>(count), false);
  for (const CircleObservation& circle : trace.circles) found[static_cast<std::size_t>(circle.circle)] = true;
  std::string text = ", without";
  const std::vector<CircleVerdict>& verdicts = trace.measurement.verdicts;
  for (std::size_t circle = 0; circle < found.size(); ++circle) {
    if (found[circle]) continue;
    text += print(" %zu", circle);
    if (circle < verdicts.size()) text += print(" (%s)", circleVerdictName(verdicts[circle]));
  }
  return text;
}

// Minimum number of circles of a view.
int minCircles(const WindowAnalysis& analysis, const GridOptions& options) {
  int least = 0;
  while (outcomeOf(least, *analysis.scene, options) == WindowOutcome::TooFewInGrid) ++least;
  return least;
}

void addCentres(const WindowAnalysis& analysis, const GridOptions& options,
                std::vector<StageReport>& stages) {
  const int count = analysis.scene->board.pointCount();
  const WindowTrace& trace = analysis.trace();
  if (!trace.motion) {
    stages.push_back({"centres", StageVerdict::NotReached, "not reached"});
    return;
  }
  std::vector<double> sigmas;
  int half_known = 0;
  for (const CircleObservation& circle : trace.circles) {
    if (onlyKnownDirection(circle.covariance_px2))
      ++half_known;
    else
      sigmas.push_back(std::sqrt(0.5 * circle.covariance_px2.trace()));
  }
  std::string text =
      print("%zu of %d %s measured", trace.circles.size(), count, pointsName(analysis.scene->board));
  if (half_known > 0) text += print(", %d of them across one line only", half_known);
  if (!sigmas.empty()) text += print(", sigma %.3f px", medianOf(std::move(sigmas)));
  const bool good = windowClass(analysis.outcome) != WindowClass::Missed;
  if (analysis.outcome == WindowOutcome::TooFewInGrid)
    text += print(" (at least %d needed)", minCircles(analysis, options));
  text += missingText(trace, count);
  stages.push_back({"centres", good ? StageVerdict::Passed : StageVerdict::Failed, text});
}

}  // namespace

std::vector<StageReport> describeStages(const WindowAnalysis& analysis, const FrontEndOptions& options) {
  std::vector<StageReport> stages;
  addTracking(analysis, options, stages);
  const BoardSearch* best = analysis.bestSearch();
  if (best) addSearchStages(*best, analysis, options, stages);
  for (const BoardSearch& search : analysis.searches) {
    if (&search == best) continue;
    stages.push_back({sourceName(search.source), StageVerdict::Note,
                      std::string("also tried: ") + windowOutcomeName(search.outcome)});
  }
  addCentres(analysis, options.grid, stages);
  return stages;
}

}  // namespace evical::ui
