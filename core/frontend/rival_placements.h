// Other placements of a board on its detected lattice. An asymmetric grid that is shifted, or rotated by a
// quarter or a half turn, coincides with most of its circles, and a partial view may not distinguish several
// placements.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/window_trace.h"

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <vector>

namespace evical {

// Agreement of a placement of the board with a window.
struct PlacementScore {
  Eigen::Matrix3d shift =
      Eigen::Matrix3d::Identity();       // of the board's plane: from the rival to the present placement
  double measured = 0.0, missing = 0.0;  // points that it explains, and points in view that it does not
  double absent = 0.0;                   // of squares: edges in view without events, in the unit of points

  double value() const { return measured - missing - absent; }
  // True if this one is ahead of the rival even if something covers the edges without events.
  bool excludes(const PlacementScore& rival, double margin) const {
    const double ahead = measured - missing - (rival.measured - rival.missing);
    return std::min(ahead, value() - rival.value()) >= margin;
  }
};

// The present placement of the board, and all others on the same lattice, in the order of `shifts`
// (rivalShifts).
std::vector<PlacementScore> rivalPlacements(const BoardMotion& laid,
                                            const std::vector<Eigen::Matrix3d>& shifts,
                                            const BurstWindow& window, const BoardScene& scene,
                                            double half_window_s, const TrackingOptions& options);

// Best first.
void sortByValue(std::vector<PlacementScore>& rivals);

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

  // After a new detection of the board: all placements are open. `distinguished`: by the search; empty if
  // only checks count, once there are any.
  void begin(std::optional<bool> distinguished);
  bool isDue() const { return wait_ <= 1; }
  void skip() { --wait_; }  // a window without a check

  // Checks one tracked window. Returns the shift to the rival that explained enough consecutive windows
  // better, or nothing.
  std::optional<Eigen::Matrix3d> look(const BurstWindow& window, const WindowTrace& trace,
                                      const BoardScene& scene, const TrackingOptions& options);

  // The shift to the rival that is where the board was expected; empty if none is, or if two might be.
  std::optional<Eigen::Matrix3d> continuationOf(const BoardMotion& expected, const BoardMotion& found,
                                                const Board& board) const;

  // The visible circles of the last checks exclude all other placements.
  bool isSettled() const { return agreeing_ >= options_.contradicting_looks; }
  // False if no check since begin(), or since the last contradiction, ranked the board ahead of all rivals.
  // True without checks.
  bool isDistinguished() const { return distinguished_.value_or(true); }

 private:
  std::optional<Eigen::Matrix3d> contradicted(const Eigen::Matrix3d& shift);
  void agreed(int in_a_row);
  // Squares: adds a window's scores to those of the windows before, which count less and less. Returns how
  // many times larger differences by chance are than in one window.
  double sumUp(std::vector<PlacementScore>& rivals);

  GridOptions options_;
  std::vector<Eigen::Matrix3d> shifts_;
  Eigen::Matrix3d favourite_ = Eigen::Matrix3d::Identity();
  int contradicting_ = 0, agreeing_ = 0;  // consecutive checks; a check agrees if it leaves no rival open
  int wait_ = 0;                          // windows until the next check
  std::optional<bool> distinguished_;     // empty: no check yet
  // Squares: sums over windows, by shift, and of the squares of the windows' weights.
  std::vector<PlacementScore> sums_;
  double squared_weights_ = 0.0;
};

}  // namespace evical
