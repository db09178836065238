// Other placements of a board on the lattice that it was found on. An asymmetric grid that is shifted, or
// rotated by a quarter or a half turn, meets most of its circles, and a view that shows a part of it may
// leave several open.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/front_end_options.h"
#include "core/frontend/window_trace.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

// Agreement of a placement of the board with a window.
struct PlacementScore {
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();  // of the board's plane: from now to before
  int measured = 0, missing = 0;  // circles that it explains, and those in view that it does not

  int value() const { return measured - missing; }
};

// The board with its present placement, and with every other on the same lattice (`shifts` from
// latticeShifts): best first.
std::vector<PlacementScore> rivalPlacements(const BoardMotion& laid,
                                            const std::vector<Eigen::Matrix3d>& shifts,
                                            const BurstWindow& window, const BoardScene& scene,
                                            double half_window_s, const TrackingOptions& options);

// The same board with a rival's placement.
BoardMotion shifted(const BoardMotion& motion, const Eigen::Matrix3d& shift);

// Board circle of the rival for each circle of the present placement; -1 if the rival has none.
std::vector<int> renumbering(const Board& board, const Eigen::Matrix3d& shift);

// Compares a tracked board with its rivals: at every window while one of them is open (it explains about as
// many circles), and now and then after the visible circles have excluded them all.
class PlacementWatch {
 public:
  PlacementWatch(const Board& board, const GridOptions& options);

  void begin();  // a board that was found again: all is open
  bool isDue() const { return wait_ <= 1; }
  void pass() { --wait_; }  // a window goes by without a look

  // Looks at one tracked window. The shift to the rival that has explained enough of them in a row better; nothing while
  // there is none.
  std::optional<Eigen::Matrix3d> look(const BurstWindow& window, const WindowTrace& trace,
                                      const BoardScene& scene, const TrackingOptions& options);

  // The visible circles of the last checks exclude all other placements.
  bool isSettled() const { return agreeing_ >= options_.contradicting_looks; }
  // Some look since begin(), or since the last one that contradicted, put the board ahead of all rivals, as a search has
  // to before it is believed; or there was no look.
  bool isTold() const { return told_.value_or(true); }

 private:
  std::optional<Eigen::Matrix3d> contradicted(const Eigen::Matrix3d& shift);
  void agreed(int in_a_row);

  GridOptions options_;
  std::vector<Eigen::Matrix3d> shifts_;
  Eigen::Matrix3d favourite_ = Eigen::Matrix3d::Identity();
  int contradicting_ = 0, agreeing_ = 0;  // looks in a row; only those agree that leave no rival open
  int wait_ = 0;                          // windows until the next look
  std::optional<bool> told_;              // none: no look yet
};

}  // namespace evical
