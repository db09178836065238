// Finds the board in one window from nothing: circle candidates, moving circles, lattice, placement, and the
// joint fit that decides between placements.
#pragma once

#include "core/data/board_observations.h"
#include "core/frontend/board_motion.h"
#include "core/frontend/board_placement.h"
#include "core/frontend/board_scene.h"
#include "core/frontend/circle_candidate.h"
#include "core/frontend/circle_lattice.h"
#include "core/frontend/front_end_options.h"

#include <optional>
#include <vector>

namespace evical {

// Everything a drawing may want to show; the outcome says how far it came.
struct BoardSearch {
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  double half_window_s = 0.0;
  int bursts = 0;
  std::vector<CircleCandidate> candidates;
  std::vector<MovingCircle> circles;
  CircleLattice lattice;
  std::vector<BoardPlacement> placements;
  std::optional<BoardMotion> motion;
};

// Tries window lengths until one shows the board; the last try is returned if none does.
BoardSearch searchBoard(const BurstHistory& history, std::int64_t middle_ns, const BoardScene& scene,
                        const FrontEndOptions& options);

}  // namespace evical
