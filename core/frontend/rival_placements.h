// The other ways to lay a board on the lattice that it was found on: an asymmetric grid that is shifted, or turned by a
// quarter or a half, meets most of its own circles, and a view that shows a part of it may leave several open.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/front_end_options.h"
#include "core/frontend/window_trace.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

// How well a board that is laid in one way explains a window.
struct PlacementScore {
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();  // of the board's plane: from now to before
  int measured = 0, missing = 0;  // circles that it explains, and those in view that it does not

  int value() const { return measured - missing; }
};

// The board as it is laid, and every other way to lay it on the same lattice (latticeShifts): best first.
std::vector<PlacementScore> rivalPlacements(const BoardMotion& laid, const BurstWindow& window,
                                            const BoardScene& scene, double half_window_s,
                                            const FrontEndOptions& options);

// The same board laid like a rival.
BoardMotion shifted(const BoardMotion& motion, const Eigen::Matrix3d& shift);

// Board circle of the rival for each circle of the board as it was laid; -1 where the rival has none.
std::vector<int> renumbering(const Board& board, const Eigen::Matrix3d& shift);

// Holds a tracked board against its rivals.
class PlacementWatch {
 public:
  // Looks at one tracked window. The shift to the rival that has explained enough of them in a row better; nothing while
  // there is none.
  std::optional<Eigen::Matrix3d> look(const BurstWindow& window, const WindowTrace& trace,
                                      const BoardScene& scene, const FrontEndOptions& options);
  void reset() { looks_ = 0; }

 private:
  Eigen::Matrix3d favourite_ = Eigen::Matrix3d::Identity();
  int looks_ = 0;  // in a row
};

}  // namespace evical
