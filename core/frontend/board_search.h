// Search for the board in one window without a prediction: circle candidates, moving circles, lattice,
// placement, and the joint fit that selects a placement.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/board_motion.h"
#include "core/frontend/board_placement.h"
#include "core/frontend/board_scene.h"
#include "core/frontend/circle_candidate.h"
#include "core/frontend/circle_pairs.h"
#include "core/frontend/corner_lattice.h"
#include "core/frontend/detection_options.h"

#include <optional>
#include <utility>
#include <vector>

namespace evical {

// Stages of a search, in this order.
enum class SearchStage { Bursts, Candidates, Circles, Lattice, Placement, JointFit, Done };

// Results of all stages, for drawings.
struct BoardSearch {
  CandidateSource source = CandidateSource::NormalFlow;
  SearchStage ended = SearchStage::Bursts;  // the stage that failed; Done: the board was found
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  double half_window_s = 0.0;
  int bursts = 0;
  std::vector<CircleCandidate> candidates;
  std::vector<MovingCircle> circles;
  CircleLattice lattice;
  std::vector<SaddleCandidate> saddles;  // of a board of squares, instead of candidates and circles
  CornerLattice corners;                 // and instead of their lattice
  std::vector<BoardPlacement> placements;
  std::optional<BoardMotion> motion;
  bool distinguished = true;                   // false: another placement of squares explains about as much
  BoardExtent extent;                          // of squares, of an outcome TooFewInGrid or OtherPattern
  double narrowest_px = 0.0;                   // of an outcome TooSmall: narrowestInk_px
  std::optional<std::pair<int, int>> numbers;  // of an outcome OtherPattern: the first and last tag seen
  std::shared_ptr<const BoardEdges> edges;     // of the print that was found, of a board of squares
};

// One search for each source of candidates that was tried, in order: the options' method first, and the other
// one if it does not find the board. Each tries several window lengths until one finds the board; its last
// attempt is returned.
std::vector<BoardSearch> searchBoard(const BurstHistory& history, std::int64_t middle_ns,
                                     const BoardScene& scene, const FrontEndOptions& options);

// Largest distance of bursts from the middle in any search, however slowly edges move.
inline constexpr double kSearchReach_s = 0.08;

// Normal flow around an instant, for drawings: in a window of this length, or in the first window of a search
// by flow.
struct FlowAround {
  double half_window_s = 0.0;
  NormalFlowStages arcs;
};
FlowAround flowAround(const BurstHistory& history, std::int64_t middle_ns,
                      std::optional<double> half_window_s, const BoardScene& scene,
                      const FrontEndOptions& options);

}  // namespace evical
