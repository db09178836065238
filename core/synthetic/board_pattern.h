// Printed pattern of a board: circles, squares, or tags like Kalibr's AprilGrid, with a border of two modules
// and a small black square at every corner between tags, or ChArUco boards with usual markers.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/marker_bits.h"
#include "core/geometry/tag_bits.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

class BoardPattern {
 public:
  // `tag_turns`: quarter turns of each tag or marker within its square, clockwise.
  explicit BoardPattern(const Board& board, int tag_turns = 0);

  // True on ink, at metres on the board; paper beyond its edge.
  bool isInk(const Eigen::Vector2f& p) const;

  // The printed part's corners.
  const Eigen::Vector2f& low_m() const { return low_m_; }
  const Eigen::Vector2f& high_m() const { return high_m_; }

 private:
  bool inCircle(const Eigen::Vector2f& p) const;
  bool inDarkSquare(const Eigen::Vector2f& p) const;
  bool inTag(const Eigen::Vector2f& p) const;
  bool inMarker(const Eigen::Vector2f& p) const;

  Board board_;
  float spacing_m_, radius_m_, tag_m_;
  Eigen::Vector2f low_m_, high_m_;
  std::vector<TagBits> tags_;
  std::vector<PatternBits> markers_;
};

}  // namespace evical
