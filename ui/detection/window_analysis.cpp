// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_analysis.h"

#include "core/base/stopwatch.h"
#include "core/base/time.h"
#include "core/frontend/circle_measurement.h"
#include "core/frontend/ring_vote.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

constexpr double kSearchReach_s = 0.08;  // the longest half window of a search
constexpr double kSlowest_px_s = 10.0;

std::int64_t middleOf(const WindowQuestion& question) {
  return question.start_ns + nanosecondsFrom(question.time_s);
}

std::vector<EdgeBurst> gather(const BurstHistory& history, std::int64_t middle_ns, double half_width_s) {
  std::vector<EdgeBurst> bursts;
  const std::int64_t half_ns = nanosecondsFrom(half_width_s);
  history.gather(middle_ns - half_ns, middle_ns + half_ns, bursts);
  return bursts;
}

// The board as the circles of an earlier view say it lay and moved.
std::optional<BoardMotion> motionOf(const BoardView& view, const WindowQuestion& question) {
  std::vector<Eigen::Vector2d> on_board, in_image;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const CircleObservation& circle : view.circles) {
    on_board.push_back(question.scene->board.centre_m(circle.circle));
    in_image.push_back(circle.centre_px + (view.time_s - circle.time_s) * circle.velocity_px_s);
    low = low.cwiseMin(in_image.back());
    high = high.cwiseMax(in_image.back());
  }
  const std::optional<Eigen::Matrix3d> homography = fitHomography(on_board, in_image);
  if (!homography) return std::nullopt;
  BoardMotion motion;
  motion.time_ns = question.start_ns + nanosecondsFrom(view.time_s);
  motion.ideal_from_board = *homography;
  motion.frame = {0.5 * (low + high), std::max(0.5 * (high - low).norm(), 1.0)};
  Eigen::Matrix<double, 8, 8> matrix = 1e-6 * Eigen::Matrix<double, 8, 8>::Identity();
  PlaneFlow vector = PlaneFlow::Zero();
  for (std::size_t k = 0; k < in_image.size(); ++k) {
    const PlaneFlowBasis basis = motion.frame.basis(in_image[k]);
    matrix += basis.transpose() * basis;
    vector += basis.transpose() * view.circles[k].velocity_px_s;
  }
  motion.velocity_px_s = matrix.ldlt().solve(vector);
  return motion;
}

// The last view before the window that the tracker would still go on from.
const BoardView* viewBefore(const WindowQuestion& question) {
  if (!question.observations) return nullptr;
  constexpr double kSame_s = 1e-6;
  const std::vector<BoardView>& views = question.observations->views;
  const auto before = [](const BoardView& view, double time_s) { return view.time_s < time_s; };
  const auto next = std::lower_bound(views.begin(), views.end(), question.time_s - kSame_s, before);
  if (next == views.begin()) return nullptr;
  const BoardView& view = *std::prev(next);
  return question.time_s - view.time_s > question.options.tracking.longest_gap_s ? nullptr : &view;
}

double fitHalfWidth_s(const BoardMotion& motion, const WindowQuestion& question) {
  const BoardScene& scene = *question.scene;
  const TrackingOptions& options = question.options.tracking;
  const double speed_px_s = boardSpeed_px_s(motion, scene);
  return std::min(1.5 * fitHalfWindow_s(speed_px_s, options), options.longest_fit_half_window_s);
}

// Fitted to its own bursts once more, since observations keep less of a board's motion than the tracker does.
void predict(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis) {
  const BoardView* view = viewBefore(question);
  if (!view) return;
  std::optional<BoardMotion> motion = motionOf(*view, question);
  if (!motion) return;
  const BoardScene& scene = *question.scene;
  BurstWindow window(scene);
  window.assign(gather(history, motion->time_ns, fitHalfWidth_s(*motion, question)), motion->time_ns);
  if (const auto refitted = fitBoardMotion(window, *motion, scene, question.options.tracking.first_gate_px,
                                           question.options.tracking))
    motion = refitted;
  analysis.prediction = predicted(*motion, middleOf(question));
  analysis.predicted_from_s = view->time_s;
}

void findInliers(const BurstWindow& window, const WindowQuestion& question, WindowAnalysis& analysis) {
  const BoardScene& scene = *question.scene;
  const TrackingOptions& options = question.options.tracking;
  for (const CircleImage& circle : projectBoard(analysis.motion->ideal_from_board, scene)) {
    const Eigen::Vector2d velocity = analysis.motion->velocityAt(circle.centre_px);
    const double reach_px =
        circle.sensor_radius_px + options.last_gate_px + 1.5 * velocity.norm() * question.half_width_s;
    const Eigen::Vector2d& middle = circle.sensor_centre_px;
    window.visitBox(
        middle.x() - reach_px, middle.x() + reach_px, middle.y() - reach_px, middle.y() + reach_px,
        [&](std::uint32_t i) {
          const WindowBurst& burst = window.bursts()[i];
          const double time_s = static_cast<double>(burst.time_s);
          if (std::abs(time_s) > question.half_width_s) return;
          const Eigen::Vector2d pixel = Eigen::Vector2f(burst.ideal_x_px, burst.ideal_y_px).cast<double>();
          const EdgeDistance edge = distanceToEdge(circle, pixel - analysis.motion->travel(pixel, time_s));
          const double off_px =
              edge.distance_px / burst.stretch.across(edge.normal) - analysis.motion->radius_offset_px;
          if (!(std::abs(off_px) < options.last_gate_px)) return;
          if (static_cast<double>(burst.lead) * edge.normal.dot(velocity) < 0.0) return;
          analysis.inliers.push_back({{burst.x_px, burst.y_px}, burst.lead > 0.0f});
        });
  }
}

// From a prediction or a found board to measured centres, as the tracker does it. True if it would go on from
// here.
bool measure(const BurstHistory& history, const WindowQuestion& question, const BoardMotion& start,
             WindowAnalysis& analysis) {
  const BoardScene& scene = *question.scene;
  const TrackingOptions& options = question.options.tracking;
  BurstWindow window(scene);
  window.assign(
      gather(history, middleOf(question), std::max(fitHalfWidth_s(start, question), question.half_width_s)),
      middleOf(question));
  analysis.motion = fitBoardMotion(window, start, scene, options.first_gate_px, options);
  analysis.circles.clear();
  analysis.inliers.clear();
  if (!analysis.motion) return false;
  analysis.circles =
      measureCircles(window, *analysis.motion, scene, question.half_width_s, question.start_ns, options);
  const int expected = expectedCircles(*analysis.motion, scene, question.half_width_s);
  const int found = static_cast<int>(analysis.circles.size());
  findInliers(window, question, analysis);
  return found >= question.options.grid.least_circles && 2 * found >= expected;
}

WindowOutcome outcomeOf(const WindowAnalysis& analysis, const FrontEndOptions& options) {
  const int found = static_cast<int>(analysis.circles.size());
  const int count = analysis.scene->board.circleCount();
  if (found < std::max(4.0, options.grid.least_partial * count)) return WindowOutcome::TooFewInGrid;
  return found == count ? WindowOutcome::Complete : WindowOutcome::Partial;
}

// searchBoard's two sources, one after the other, so that both can be told about.
void searchAll(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis) {
  FrontEndOptions options = question.options;
  options.detection.try_both = false;
  const CandidateSource first = question.options.detection.method;
  const CandidateSource second =
      first == CandidateSource::RingVote ? CandidateSource::NormalFlow : CandidateSource::RingVote;
  for (const CandidateSource source : {first, second}) {
    options.detection.method = source;
    analysis.searches.push_back({source, searchBoard(history, middleOf(question), *question.scene, options)});
    if (analysis.searches.back().search.motion || !question.options.detection.try_both) return;
  }
}

double flowHalfWidth_s(const BurstHistory& history, const WindowQuestion& question,
                       const WindowAnalysis& analysis) {
  for (const SourceSearch& search : analysis.searches) {
    if (search.source == CandidateSource::NormalFlow) return search.search.half_window_s;
  }
  constexpr double kSpeedWindow_s = 0.04;
  const BoardScene& scene = *question.scene;
  BurstWindow window(scene);
  window.assign(gather(history, middleOf(question), kSpeedWindow_s), middleOf(question));
  const double speed_px_s = std::max(typicalEdgeSpeed_px_s(window), kSlowest_px_s);
  return std::clamp(question.options.normal_flow.window_travel_px / (2.0 * speed_px_s),
                    0.5 * question.options.detection.shortest_window_s, kSearchReach_s);
}

void findFlow(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis) {
  const double half_width_s = flowHalfWidth_s(history, question, analysis);
  if (half_width_s == analysis.arcs_half_width_s) return;
  analysis.arcs_half_width_s = half_width_s;
  const BoardScene& scene = *question.scene;
  BurstWindow window(scene);
  std::vector<EdgeBurst> bursts = gather(history, middleOf(question), half_width_s);
  keepSupported(scene.resolution_px, question.options.ring_vote.least_support, bursts);
  window.assign(bursts, middleOf(question));
  analysis.arcs = findArcs(window, question.options.normal_flow);
}

// How far a search came; the enumerators of WindowOutcome go by stages, but for the two good ones.
int progressOf(const BoardSearch& search) {
  return search.motion ? static_cast<int>(kWindowOutcomeCount) : static_cast<int>(search.outcome);
}

}  // namespace

TimeSpan neededBursts_s(const WindowQuestion& question) {
  const double fit_s = question.options.tracking.longest_fit_half_window_s;
  const double reach_s = std::max({kSearchReach_s, question.half_width_s, fit_s});
  const BoardView* view = viewBefore(question);
  const double begin_s = question.time_s - reach_s;
  return {view ? std::min(begin_s, view->time_s - fit_s) : begin_s, question.time_s + reach_s};
}

const SourceSearch* WindowAnalysis::bestSearch() const {
  const SourceSearch* best = nullptr;
  for (const SourceSearch& search : searches) {
    if (!best || progressOf(search.search) > progressOf(best->search)) best = &search;
  }
  return best;
}

WindowAnalysis trackWindow(const BurstHistory& history, const WindowQuestion& question) {
  const Stopwatch stopwatch;
  WindowAnalysis analysis;
  analysis.time_s = question.time_s;
  analysis.half_width_s = question.half_width_s;
  analysis.scene = question.scene;
  predict(history, question, analysis);
  if (analysis.prediction) {
    analysis.tracked = measure(history, question, *analysis.prediction, analysis);
    analysis.outcome =
        analysis.tracked ? outcomeOf(analysis, question.options) : WindowOutcome::RefinementFailed;
  }
  if (question.flow) findFlow(history, question, analysis);
  analysis.stages = describeStages(analysis, question.options);
  analysis.took_s = stopwatch.elapsed_s();
  return analysis;
}

void searchWindow(const BurstHistory& history, const WindowQuestion& question, WindowAnalysis& analysis) {
  const Stopwatch stopwatch;
  searchAll(history, question, analysis);
  const SourceSearch& search = *analysis.bestSearch();
  if (!analysis.tracked) {
    analysis.outcome = search.search.outcome;
    if (search.search.motion) {
      analysis.outcome = measure(history, question, *search.search.motion, analysis)
                             ? outcomeOf(analysis, question.options)
                             : WindowOutcome::RefinementFailed;
    }
  }
  if (question.flow) findFlow(history, question, analysis);
  analysis.stages = describeStages(analysis, question.options);
  analysis.took_s += stopwatch.elapsed_s();
}

}  // namespace evical::ui
