// Placements of a lattice of circles on the board: rotations, shifts, and the homography of each.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/moving_circle.h"

#include "core/geometry/point_lattice.h"

#include <optional>
#include <vector>

namespace evical {

// The lattice of moving circles, with the front end's options.

CircleLattice findCircleLattice(const std::vector<MovingCircle>& circles, const GridOptions& options);

// One placement of the lattice on the board.
struct BoardPlacement {
  std::vector<std::pair<int, std::size_t>> circles;  // board circle, index of the moving circle
  BoardMotion motion;                                // approximate: from centres and velocities only
};

// A board that is given too large has hundreds of placements on the same circles.
inline constexpr std::size_t kMaxPlacements = 48;

// Placements with nearly the largest number of circles on the board, in descending order. If the camera is
// known, at most kMaxPlacements, and only those that a camera can see: two equal, perpendicular axes behind
// the homography.
std::vector<BoardPlacement> placeOnBoard(const CircleLattice& lattice,
                                         const std::vector<MovingCircle>& circles, const BoardScene& scene,
                                         std::int64_t time_ns, const GridOptions& options);

// Homography with the points that agree; drops the others from the placement.
std::optional<Eigen::Matrix3d> fitAgreeing(std::vector<std::pair<int, std::size_t>>& placed,
                                           const std::vector<MovingPoint>& ideal, const Board& board,
                                           const GridOptions& options);

// True if the board's two axes in the camera's view are about equally long and perpendicular.
bool looksSquare(const Eigen::Matrix3d& ideal_from_board, const CameraIntrinsics& camera);

// Motions of the board plane that map the board's lattice onto itself, shifted or rotated, so that at least
// `min_overlap` of its circles coincide with circles: placements that may be confused. The identity is the
// first. Motions that differ by a symmetry of the whole lattice are listed once.
std::vector<Eigen::Matrix3d> latticeShifts(const Board& board, double min_overlap);

}  // namespace evical
