// Agreement of the edges of a whole board of squares, the bits of its tags included, with the crossings of a
// window. It decides between placements that have the same corners.
#pragma once

#include "core/frontend/board_motion.h"
#include "core/frontend/rival_placements.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace evical {

// A crossing on the board: its place, and the directions of the paper that its polarity allows, as counted in
// EdgeMap; -1: the motion is along such edges.
struct BoardCrossing {
  Eigen::Vector2d at_m;
  double tolerance_m;
  int along_x, along_y;
};

// Scores of placements of a board of squares, best first, in the unit of circles: a placement that explains a
// share of the crossings has measured that share of the points in view, and misses those that the crossings
// contradict.
std::vector<PlacementScore> rivalPatterns(const BoardMotion& laid, const std::vector<Eigen::Matrix3d>& shifts,
                                          const BurstWindow& window, const BoardScene& scene,
                                          double half_window_s, const TrackingOptions& options);

// Check of a tracked placement. Edges along the motion cause no events, so that a fit may slide along the
// others; their ends, and the bits of tags, show it.
struct SlideCheck {
  std::optional<BoardMotion> moved;  // by a few pixels to where the crossings agree, if it slid
  bool contradicted = false;         // by many crossings, also after such a move
};
SlideCheck checkSlide(const BoardMotion& laid, const BurstWindow& window, const BoardScene& scene,
                      double half_window_s);

// Properties of the print that a session does not state, and the placement, of all those that are possible
// the ones that agree best.
struct PrintMatch {
  std::shared_ptr<const BoardEdges> edges;
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  bool matches = false;  // hardly a crossing contradicts
  std::optional<std::pair<int, int>> numbers =
      {};  // if not: of an AprilGrid's tags in view, if they can be read
};
PrintMatch matchPrint(const BoardMotion& laid, const std::vector<Eigen::Matrix3d>& shifts,
                      const BurstWindow& window, const BoardScene& scene, double half_window_s);

// Motions of the plane of a board of squares that map its squares onto squares so that at least `min_overlap`
// of them coincide. The identity is the first; motions that leave the pattern unchanged are left out.
std::vector<Eigen::Matrix3d> patternShifts(const Board& board, const BoardEdges& edges, double min_overlap);

}  // namespace evical
