// Other placements of a board on its detected lattice. An asymmetric grid that is shifted, or rotated by a
// quarter or a half turn, coincides with most of its circles, and a partial view may not distinguish several
// placements.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/window_trace.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

// Agreement of a placement of the board with a window.
struct PlacementScore {
  Eigen::Matrix3d shift =
      Eigen::Matrix3d::Identity();  // of the board's plane: from the rival to the present placement
  int measured = 0, missing = 0;    // circles that it explains, and circles in view that it does not

  int value() const { return measured - missing; }
};

// The present placement of the board, and all others on the same lattice (`shifts` from
// latticeShifts): best first.
std::vector<PlacementScore> rivalPlacements(const BoardMotion& laid,
                                            const std::vector<Eigen::Matrix3d>& shifts,
                                            const BurstWindow& window, const BoardScene& scene,
                                            double half_window_s, const TrackingOptions& options);

// Motions of the board's plane to all rivals (latticeShifts, patternShifts).
std::vector<Eigen::Matrix3d> rivalShifts(const BoardScene& scene, double min_overlap);

// The same board with a rival's placement.
BoardMotion shifted(const BoardMotion& motion, const Eigen::Matrix3d& shift);

// Board circle of the rival for each circle of the present placement; -1 if the rival has none.
std::vector<int> renumbering(const Board& board, const Eigen::Matrix3d& shift);

// Compares a tracked board with its rivals: in every window while one of them is open (it explains about as
// many circles), and occasionally after the visible circles have excluded all of them.
class PlacementWatch {
 public:
  PlacementWatch(const BoardScene& scene, const GridOptions& options);

  void begin();  // after a new detection of the board: all placements are open
  bool isDue() const { return wait_ <= 1; }
  void skip() { --wait_; }  // a window without a check

  // Checks one tracked window. Returns the shift to the rival that explained enough consecutive windows
  // better, or nothing.
  std::optional<Eigen::Matrix3d> look(const BurstWindow& window, const WindowTrace& trace,
                                      const BoardScene& scene, const TrackingOptions& options);

  // The visible circles of the last checks exclude all other placements.
  bool isSettled() const { return agreeing_ >= options_.contradicting_looks; }
  // False if no check since begin(), or since the last contradiction, ranked the board ahead of all rivals,
  // as is required of a search. True without checks.
  bool isDistinguished() const { return distinguished_.value_or(true); }

 private:
  std::optional<Eigen::Matrix3d> contradicted(const Eigen::Matrix3d& shift);
  void agreed(int in_a_row);

  GridOptions options_;
  std::vector<Eigen::Matrix3d> shifts_;
  Eigen::Matrix3d favourite_ = Eigen::Matrix3d::Identity();
  int contradicting_ = 0, agreeing_ = 0;  // consecutive checks; a check agrees if it leaves no rival open
  int wait_ = 0;                          // windows until the next check
  std::optional<bool> distinguished_;     // empty: no check yet
};

}  // namespace evical
