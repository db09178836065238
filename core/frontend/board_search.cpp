#include "core/frontend/board_search.h"

#include "core/frontend/board_extent.h"
#include "core/frontend/circle_measurement.h"
#include "core/frontend/lattice_waves.h"
#include "core/frontend/pattern_agreement.h"
#include "core/frontend/ring_vote.h"
#include "core/frontend/rival_placements.h"
#include "core/frontend/window_trace.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/homography.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace evical {
namespace {

// Window lengths that are tried, relative to the one in which edges travel the distance of the options.
constexpr std::array kWindowFactors = {1.0, 2.0, 0.5};
constexpr std::array kWaveHalfWindows_s = {0.05, 0.025};  // in which edges travel less than a square
constexpr double kSpeedHalfWindow_s = 0.04;               // for the edges' typical speed
constexpr double kSlowest_px_s = 10.0;                    // lower limit of speeds
constexpr double kRoughGateFactor =
    1.5;  // factor on the first gate: placements are less accurate than predictions

CandidateSource otherThan(CandidateSource source) {
  return source == CandidateSource::RingVote ? CandidateSource::NormalFlow : CandidateSource::RingVote;
}

std::vector<CircleCandidate> findCandidates(const BurstWindow& window, CandidateSource source,
                                            const FrontEndOptions& options) {
  if (source == CandidateSource::NormalFlow) return pairArcs(window, options);
  return voteForCircles(window, options);
}

// A fitted placement: the number of circles that it explains, and of those in view that it does not.
struct Judged {
  BoardMotion motion;
  int measured = 0, missing = 0;

  int value() const { return measured - missing; }
};

Judged judgeFitted(const BoardMotion& motion, const BurstWindow& window, const BoardScene& scene,
                   double half_window_s, const FrontEndOptions& options) {
  const auto circles = measureCircles(window, motion, scene, {half_window_s}, options.tracking);
  const auto measured = static_cast<int>(circles.size());
  const int expected = expectedCircles(motion, scene, half_window_s);
  return Judged{motion, measured, std::max(expected - measured, 0)};
}

std::optional<Judged> judge(const BoardPlacement& placement, const BurstWindow& window,
                            const BoardScene& scene, double half_window_s, const FrontEndOptions& options) {
  const std::optional<BoardMotion> rough = fitBoardMotion(
      window, placement.motion, scene, kRoughGateFactor * options.tracking.first_gate_px, options.tracking);
  if (!rough) return std::nullopt;
  const std::optional<BoardMotion> motion =
      fitBoardMotion(window, *rough, scene, options.tracking.first_gate_px, options.tracking);
  if (!motion) return std::nullopt;
  return judgeFitted(*motion, window, scene, half_window_s, options);
}

// Placements on the same circles: the first one, and the motions of the board's plane from each of them to
// it.
struct PlacementGroup {
  const BoardPlacement* first = nullptr;
  std::vector<Eigen::Matrix3d> shifts = {Eigen::Matrix3d::Identity()};
};

// Motion of the board's plane from `other` to `first`, if `first` has all circles of `other`.
std::optional<Eigen::Matrix3d> shiftBetween(const BoardPlacement& first, const BoardPlacement& other,
                                            const Board& board) {
  std::map<std::size_t, int> circle_of;
  for (const auto& [circle, index] : first.circles) circle_of[index] = circle;
  Eigen::Matrix2Xd from(2, static_cast<Eigen::Index>(other.circles.size())), to = from;
  Eigen::Index column = 0;
  for (const auto& [circle, index] : other.circles) {
    const auto found = circle_of.find(index);
    if (found == circle_of.end()) return std::nullopt;
    from.col(column) = board.point_m(circle);
    to.col(column++) = board.point_m(found->second);
  }
  const Eigen::Matrix3d shift = Eigen::umeyama(from, to, false);
  constexpr double kSamePlace = 1e-3;  // of the spacing
  const Eigen::Matrix2Xd residuals = (shift * from.colwise().homogeneous()).colwise().hnormalized() - to;
  if (residuals.colwise().norm().maxCoeff() > kSamePlace * board.spacing_m) return std::nullopt;
  return shift;
}

// If the given board is larger than the lattice, it has many placements there. A fit takes as long as a
// tracked window, and is the same for all of them.
std::vector<PlacementGroup> groupedByCircles(const std::vector<BoardPlacement>& placements,
                                             const Board& board) {
  std::vector<PlacementGroup> groups;
  for (std::size_t k = 0; k < std::min(placements.size(), kMaxPlacements); ++k) {
    bool known = false;
    for (PlacementGroup& group : groups) {
      const auto shift = shiftBetween(*group.first, placements[k], board);
      if (!shift) continue;
      group.shifts.push_back(*shift);
      known = true;
      break;
    }
    if (!known) groups.push_back({&placements[k]});
  }
  return groups;
}

// The placement of the best rival. Its circles are measured; its corners are not yet.
Judged shiftedTo(const PlacementScore& rival, const Judged& judged, const BurstWindow& window,
                 const BoardScene& scene, double half_window_s, const FrontEndOptions& options) {
  const BoardMotion motion = shifted(judged.motion, rival.shift);
  if (scene.edges) return judgeFitted(motion, window, scene, half_window_s, options);
  return Judged{motion, static_cast<int>(std::lround(rival.measured)),
                static_cast<int>(std::lround(rival.missing))};
}

// Edges of any speed are found in a long window, but measured in one that suits theirs.
double measuredHalf_s(const BoardSearch& search, const BoardScene& scene, const FrontEndOptions& options) {
  if (!scene.edges) return search.half_window_s;
  return fitHalfWindow_s(boardSpeed_px_s(search.placements.front().motion, scene), options.tracking);
}

// The best of the placements, jointly fitted; empty if none can be fitted.
std::optional<Judged> bestFit(const BurstWindow& window, const BoardScene& scene, double half_s,
                              const FrontEndOptions& options, const BoardSearch& search) {
  std::optional<Judged> best;
  for (const PlacementGroup& group : groupedByCircles(search.placements, scene.board)) {
    std::optional<Judged> judged = judge(*group.first, window, scene, half_s, options);
    if (!judged) continue;
    const bool undecided = scene.edges || judged->measured < scene.board.pointCount();
    if (undecided && group.shifts.size() > 1) {
      std::vector<PlacementScore> rivals =
          rivalPlacements(judged->motion, group.shifts, window, scene, half_s, options.tracking);
      sortByValue(rivals);
      judged = shiftedTo(rivals.front(), *judged, window, scene, half_s, options);
    }
    if (!best || judged->value() > best->value()) best = judged;
    if (!scene.edges && best->measured == scene.board.pointCount()) break;
  }
  return best;
}

// True if enough of the board is there. Of single events few corners can be measured: there, crossings must
// agree.
bool showsBoard(const Judged& best, const PlacementScore& agreement, const BoardScene& scene,
                const GridOptions& options) {
  constexpr double kMaxContradiction = 0.2;
  const int count = scene.board.pointCount();
  if (best.measured < std::max<double>(options.min_circles, minPartial(count, options))) return false;
  if (scene.single_events) return agreement.missing <= kMaxContradiction * agreement.measured;
  return best.missing <= options.max_missing * best.measured;
}

BoardExtent extentAt(const BoardMotion& motion, const BurstWindow& window, const BoardScene& scene,
                     double half_window_s, const FrontEndOptions& options) {
  WindowTrace trace;
  trace.motion = motion;
  trace.report.half_width_s = half_window_s;
  BoardExtent extent;
  judgeExtent(window, trace, scene, options, extent);
  return extent;
}

WindowOutcome choosePlacement(const BurstWindow& window, const BoardScene& given,
                              const FrontEndOptions& options, BoardSearch& search) {
  BoardScene scene = given;  // with the print that is found
  const double half_s = measuredHalf_s(search, scene, options);
  std::optional<Judged> best = bestFit(window, scene, half_s, options, search);
  if (!best) return WindowOutcome::RefinementFailed;
  const int count = scene.board.pointCount();
  PlacementScore first;
  if (scene.edges || best->measured < count) {
    const std::vector<Eigen::Matrix3d> shifts = rivalShifts(scene, options.grid.min_rival_overlap);
    if (scene.edges && scene.board.hasTags()) {
      const PrintMatch match = matchPrint(best->motion, shifts, window, scene, half_s);
      search.numbers = match.numbers;
      if (!match.matches) {
        search.extent = extentAt(best->motion, window, scene, half_s, options);
        return WindowOutcome::OtherPattern;
      }
      search.edges = match.edges;
      best->motion = shifted(best->motion, match.shift);
      scene.edges = match.edges;
    }
    std::vector<PlacementScore> rivals =
        rivalPlacements(best->motion, shifts, window, scene, half_s, options.tracking);
    sortByValue(rivals);
    first = rivals.front();
    best = shiftedTo(first, *best, window, scene, half_s, options);
    const bool undecided = !std::all_of(rivals.begin() + 1, rivals.end(), [&](const PlacementScore& rival) {
      return first.excludes(rival, options.grid.ambiguity_margin);
    });
    if (undecided && !scene.edges && best->measured < count) return WindowOutcome::Ambiguous;
    search.distinguished = !undecided || !scene.edges;  // squares: later windows may decide
  }
  if (!showsBoard(*best, first, scene, options.grid)) {
    if (scene.edges) {
      search.narrowest_px = narrowestInk_px(best->motion.ideal_from_board, scene);
      search.extent = extentAt(best->motion, window, scene, half_s, options);
    }
    return scene.edges && search.narrowest_px < kMinInk_px ? WindowOutcome::TooSmall
                                                           : WindowOutcome::TooFewInGrid;
  }
  search.motion = best->motion;
  return best->measured == count ? WindowOutcome::Complete : WindowOutcome::Partial;
}

void fail(BoardSearch& search, SearchStage stage, WindowOutcome outcome) {
  search.ended = stage;
  search.outcome = outcome;
}

// A motion without rotation.
PlaneFlow shiftBy(const Eigen::Vector2d& velocity_px_s, const BoardScene& scene, const ImageFrame& frame) {
  Eigen::Vector2d velocity = velocity_px_s;
  if (scene.camera) velocity = idealPixelScale(*scene.camera, frame.centre_px) * velocity;
  PlaneFlow shift = PlaneFlow::Zero();
  shift(0) = velocity.x();
  shift(3) = velocity.y();
  return shift;
}

// Squares in single events, which are too few for normal flow.
void searchWaves(const BurstWindow& window, const BoardScene& scene, const FrontEndOptions& options,
                 BoardSearch& search) {
  for (const WaveLattice& waves : findLatticeWaves(window, search.half_window_s)) {
    if (static_cast<int>(waves.corners.nodes.size()) < options.grid.min_circles) continue;
    const auto flow = [&](const ImageFrame& frame) { return shiftBy(waves.velocity_px_s, scene, frame); };
    std::vector<BoardPlacement> placements =
        placeOnBoard(waves.corners, waves.saddles, flow, scene, window.middle_ns(), options.grid);
    // Saddles are numbered across lattices.
    const std::size_t before = search.saddles.size();
    search.saddles.insert(search.saddles.end(), waves.saddles.begin(), waves.saddles.end());
    for (BoardPlacement& placement : placements) {
      for (auto& [circle, saddle] : placement.circles) saddle += before;
      search.placements.push_back(std::move(placement));
    }
  }
  if (search.saddles.empty()) fail(search, SearchStage::Lattice, WindowOutcome::NoLattice);
}

// Squares: saddles of both reaches; the one with the larger lattice is kept.
void searchCorners(const BurstWindow& window, const BoardScene& scene, const FrontEndOptions& options,
                   BoardSearch& search) {
  const std::vector<MovedCrossing> crossings = crossingsAtMiddle(window, options.normal_flow);
  for (const double reach_px : {options.saddle.short_reach_px, options.saddle.long_reach_px}) {
    std::vector<SaddleCandidate> saddles =
        voteForSaddles(crossings, window.resolution_px(), reach_px, options.saddle);
    CornerLattice corners =
        findCornerLattice(saddles, crossings, window.resolution_px(), scene.board, options.grid);
    if (!search.saddles.empty() && corners.nodes.size() <= search.corners.nodes.size()) continue;
    search.saddles = std::move(saddles);
    search.corners = std::move(corners);
  }
  if (static_cast<int>(search.saddles.size()) < options.grid.min_circles)
    return fail(search, SearchStage::Circles, WindowOutcome::TooFewCircles);
  if (search.corners.nodes.empty()) return fail(search, SearchStage::Lattice, WindowOutcome::NoLattice);
  const auto flow = [&](const ImageFrame& frame) { return flowOf(crossings, scene, frame); };
  search.placements =
      placeOnBoard(search.corners, search.saddles, flow, scene, window.middle_ns(), options.grid);
}

void searchCircles(const BurstWindow& window, double speed_px_s, const BoardScene& scene,
                   const FrontEndOptions& options, BoardSearch& search) {
  const GridOptions& grid = options.grid;
  search.candidates = findCandidates(window, search.source, options);
  search.circles = fitMovingCircles(window, search.candidates, speed_px_s, options.moving_circle);
  if (static_cast<int>(search.circles.size()) < grid.min_circles)
    return fail(search, SearchStage::Circles, WindowOutcome::TooFewCircles);
  search.lattice = findCircleLattice(search.circles, grid);
  if (search.lattice.size() < kMinForHomography)
    return fail(search, SearchStage::Lattice, WindowOutcome::NoLattice);
  if (static_cast<int>(search.lattice.size()) < grid.min_circles)
    return fail(search, SearchStage::Lattice, WindowOutcome::TooFewInGrid);
  search.placements = placeOnBoard(search.lattice, search.circles, scene, window.middle_ns(), grid);
}

void searchWindow(const BurstWindow& window, double speed_px_s, const BoardScene& scene,
                  const FrontEndOptions& options, BoardSearch& search) {
  search.bursts = static_cast<int>(window.bursts().size());
  if (search.bursts < options.detection.min_window_bursts)
    return fail(search, SearchStage::Bursts, WindowOutcome::TooFewEvents);
  if (scene.single_events)
    searchWaves(window, scene, options, search);
  else if (scene.edges)
    searchCorners(window, scene, options, search);
  else
    searchCircles(window, speed_px_s, scene, options, search);
  if (search.ended != SearchStage::Bursts) return;
  if (search.placements.empty()) return fail(search, SearchStage::Placement, WindowOutcome::NoLattice);
  search.outcome = choosePlacement(window, scene, options, search);
  search.ended = search.motion ? SearchStage::Done : SearchStage::JointFit;
}

// Searches around one instant, which share the typical speed and a window's memory.
class Searcher {
 public:
  Searcher(const BurstHistory& history, std::int64_t middle_ns, const BoardScene& scene,
           const FrontEndOptions& options)
      : history_(history), middle_ns_(middle_ns), scene_(scene), options_(options), window_(scene) {
    window_.fill(history, middle_ns, kSpeedHalfWindow_s);
    speed_px_s_ = std::max(typicalEdgeSpeed_px_s(window_), kSlowest_px_s);
  }

  double halfWindow_s(double factor, CandidateSource source) const {
    const double travel_px = source == CandidateSource::RingVote ? options_.ring_vote.window_travel_px
                                                                 : options_.normal_flow.window_travel_px;
    return std::clamp(factor * travel_px / (2.0 * speed_px_s_), 0.5 * options_.detection.min_window_s,
                      kSearchReach_s);
  }

  const BurstWindow& windowOf(double half_window_s) {
    window_.fillSupported(history_, middle_ns_, half_window_s, options_.ring_vote.min_support);
    return window_;
  }

  BoardSearch searchBy(CandidateSource source) {
    BoardSearch search;
    if (scene_.single_events) {
      for (const double half_s : kWaveHalfWindows_s) {
        search = BoardSearch{};
        search.half_window_s = half_s;
        searchWindow(windowOf(kSearchReach_s), speed_px_s_, scene_, options_, search);
        if (search.motion) break;
      }
      return search;
    }
    if (scene_.edges) {
      search.half_window_s = kSearchReach_s;
      searchWindow(windowOf(kSearchReach_s), speed_px_s_, scene_, options_, search);
      return search;
    }
    for (const double factor : kWindowFactors) {
      const double half_s = halfWindow_s(factor, source);
      if (factor > 1.0 && half_s == search.half_window_s) continue;
      search = BoardSearch{};
      search.source = source;
      search.half_window_s = half_s;
      searchWindow(windowOf(half_s), speed_px_s_, scene_, options_, search);
      if (search.motion) break;
    }
    return search;
  }

 private:
  const BurstHistory& history_;
  std::int64_t middle_ns_;
  const BoardScene& scene_;
  const FrontEndOptions& options_;
  BurstWindow window_;
  double speed_px_s_ = 0.0;
};

}  // namespace

std::vector<BoardSearch> searchBoard(const BurstHistory& history, std::int64_t middle_ns,
                                     const BoardScene& scene, const FrontEndOptions& options) {
  Searcher searcher(history, middle_ns, scene, options);
  const CandidateSource first = options.detection.method;
  std::vector<BoardSearch> searches = {searcher.searchBy(first)};
  if (!searches.front().motion && options.detection.try_both && !scene.edges)
    searches.push_back(searcher.searchBy(otherThan(first)));
  return searches;
}

FlowAround flowAround(const BurstHistory& history, std::int64_t middle_ns,
                      std::optional<double> half_window_s, const BoardScene& scene,
                      const FrontEndOptions& options) {
  Searcher searcher(history, middle_ns, scene, options);
  const double half_s = half_window_s.value_or(searcher.halfWindow_s(1.0, CandidateSource::NormalFlow));
  return {half_s, findArcs(searcher.windowOf(half_s), options)};
}

}  // namespace evical
