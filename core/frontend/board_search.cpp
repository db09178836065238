#include "core/frontend/board_search.h"

#include "core/base/time.h"
#include "core/frontend/circle_measurement.h"
#include "core/frontend/circle_pairs.h"
#include "core/frontend/ring_vote.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

constexpr double kSpeedWindow_s = 0.04;  // half window in which the typical speed is looked up
constexpr double kSlowest_px_s = 10.0;
constexpr std::size_t kMostPlacements = 48;

std::vector<CircleCandidate> findCandidates(const BurstWindow& window, CandidateSource source,
                                            const FrontEndOptions& options) {
  if (source == CandidateSource::NormalFlow) return pairArcs(window, options.normal_flow);
  return voteForCircles(window, options.ring_vote);
}

// A fitted placement: how many circles it explains, and how many of those in view it does not.
struct Judged {
  BoardMotion motion;
  int measured = 0, missing = 0;
};

Judged countCircles(const BoardMotion& motion, const BurstWindow& window, const BoardScene& scene,
                    double half_window_s, const FrontEndOptions& options) {
  const auto circles = measureCircles(window, motion, scene, half_window_s, 0, options.tracking);
  const int expected = expectedCircles(motion, scene, half_window_s);
  const auto measured = static_cast<int>(circles.size());
  return {motion, measured, std::max(expected - measured, 0)};
}

std::optional<Judged> judge(const BoardPlacement& placement, const BurstWindow& window,
                            const BoardScene& scene, double half_window_s, const FrontEndOptions& options) {
  const std::optional<BoardMotion> rough =
      fitBoardMotion(window, placement.motion, scene, 1.5 * options.tracking.first_gate_px, options.tracking);
  if (!rough) return std::nullopt;
  const std::optional<BoardMotion> motion =
      fitBoardMotion(window, *rough, scene, options.tracking.first_gate_px, options.tracking);
  if (!motion) return std::nullopt;
  return countCircles(*motion, window, scene, half_window_s, options);
}

int value(const Judged& judged) {
  return judged.measured - judged.missing;
}

// The fitted board again, and every other way to lay it on the same lattice: best first.
std::vector<Judged> rivalsOf(const Judged& fitted, const BurstWindow& window, const BoardScene& scene,
                             double half_window_s, const FrontEndOptions& options) {
  std::vector<Judged> rivals;
  for (const Eigen::Matrix3d& shift : latticeShifts(scene.board, options.grid.least_rival_overlap)) {
    BoardMotion motion = fitted.motion;
    motion.ideal_from_board = fitted.motion.ideal_from_board * shift;
    motion.ideal_from_board /= motion.ideal_from_board(2, 2);
    rivals.push_back(countCircles(motion, window, scene, half_window_s, options));
  }
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const Judged& a, const Judged& b) { return value(a) > value(b); });
  return rivals;
}

WindowOutcome choosePlacement(const BurstWindow& window, const BoardScene& scene,
                              const FrontEndOptions& options, BoardSearch& search) {
  std::optional<Judged> best;
  for (std::size_t k = 0; k < std::min(search.placements.size(), kMostPlacements); ++k) {
    const std::optional<Judged> judged =
        judge(search.placements[k], window, scene, search.half_window_s, options);
    if (judged && (!best || value(*judged) > value(*best))) best = judged;
    if (best && best->measured == scene.board.circleCount()) break;
  }
  if (!best) return WindowOutcome::RefinementFailed;
  const int count = scene.board.circleCount();
  if (best->measured < count) {
    const std::vector<Judged> rivals = rivalsOf(*best, window, scene, search.half_window_s, options);
    best = rivals.front();
    if (best->measured < count && rivals.size() > 1 &&
        value(rivals[1]) > value(*best) - options.grid.ambiguity_margin) {
      return WindowOutcome::Ambiguous;
    }
  }
  if (best->measured < std::max<double>(options.grid.least_circles, options.grid.least_partial * count) ||
      best->missing > options.grid.most_missing * best->measured) {
    return WindowOutcome::TooFewInGrid;
  }
  search.motion = best->motion;
  return best->measured == count ? WindowOutcome::Complete : WindowOutcome::Partial;
}

void searchWindow(BurstWindow& window, std::vector<EdgeBurst>& bursts, std::int64_t middle_ns,
                  double speed_px_s, CandidateSource source, const BoardScene& scene,
                  const FrontEndOptions& options, BoardSearch& search) {
  keepSupported(scene.resolution_px, options.ring_vote.least_support, bursts);
  window.assign(bursts, middle_ns);
  search.bursts = static_cast<int>(bursts.size());
  if (search.bursts < options.detection.least_window_bursts) {
    search.outcome = WindowOutcome::TooFewEvents;
    return;
  }
  search.candidates = findCandidates(window, source, options);
  search.circles = fitMovingCircles(window, search.candidates, speed_px_s, options.moving_circle);
  if (static_cast<int>(search.circles.size()) < options.grid.least_circles) {
    search.outcome = WindowOutcome::TooFewCircles;
    return;
  }
  search.lattice = findCircleLattice(search.circles, options.grid);
  if (search.lattice.size() < 4) {
    search.outcome = WindowOutcome::NoLattice;
    return;
  }
  if (static_cast<int>(search.lattice.size()) < options.grid.least_circles) {
    search.outcome = WindowOutcome::TooFewInGrid;
    return;
  }
  search.placements = placeOnBoard(search.lattice, search.circles, scene, middle_ns, options.grid);
  if (search.placements.empty()) {
    search.outcome = WindowOutcome::NoLattice;
    return;
  }
  search.outcome = choosePlacement(window, scene, options, search);
}

}  // namespace

BoardSearch searchBoard(const BurstHistory& history, std::int64_t middle_ns, const BoardScene& scene,
                        const FrontEndOptions& options) {
  constexpr std::array kWindowFactors = {1.0, 2.0, 0.5};
  constexpr double kLongestHalf_s = 0.08;
  BurstWindow window(scene);
  std::vector<EdgeBurst> bursts;
  const auto gather = [&](double half_window_s) {
    const std::int64_t half_ns = nanosecondsFrom(half_window_s);
    bursts.clear();
    history.gather(middle_ns - half_ns, middle_ns + half_ns, bursts);
  };
  gather(kSpeedWindow_s);
  window.assign(bursts, middle_ns);
  const double speed_px_s = std::max(typicalEdgeSpeed_px_s(window), kSlowest_px_s);
  const CandidateSource first = options.detection.method;
  const CandidateSource second =
      first == CandidateSource::RingVote ? CandidateSource::NormalFlow : CandidateSource::RingVote;
  BoardSearch search;
  for (const CandidateSource source : {first, second}) {
    if (source == second && !options.detection.try_both) break;
    const double travel_px = source == CandidateSource::RingVote ? options.ring_vote.window_travel_px
                                                                 : options.normal_flow.window_travel_px;
    for (const double factor : kWindowFactors) {
      const double half_s = std::clamp(factor * travel_px / (2.0 * speed_px_s),
                                       0.5 * options.detection.shortest_window_s, kLongestHalf_s);
      if (factor > 1.0 && half_s == search.half_window_s) continue;
      search = BoardSearch{};
      search.half_window_s = half_s;
      gather(half_s);
      searchWindow(window, bursts, middle_ns, speed_px_s, source, scene, options, search);
      if (search.motion) return search;
    }
  }
  return search;
}

}  // namespace evical
