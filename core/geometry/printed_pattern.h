// The printed pattern of boards without circles: rectangles of ink and paper, and the edges between them.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/marker_bits.h"
#include "core/geometry/tag_layout.h"

#include <string>
#include <vector>

namespace evical {

// Properties of printed tags that the board's dimensions do not determine.
struct TagPrint {
  int border_bits = 2;                  // AprilGrid: 2 as in Kalibr, or 1
  std::string markers = kUsualMarkers;  // ChArUco board: name of ArUco's dictionary
  int quarter_turns = 0;                // of each tag or marker within its square, clockwise
  TagOrder order = TagOrder::RowsUp;    // AprilGrid
  bool first_is_bright = false;         // ChArUco board: of its squares, the top left one
  bool blank = false;                   // dark tags without bits, bright squares without markers

  bool operator==(const TagPrint&) const = default;
};

struct PaintedBox {
  Eigen::Vector2d corner_m = Eigen::Vector2d::Zero(),
                  size_m = Eigen::Vector2d::Zero();  // in the board's frame
  bool bright = false;
};

// In painting order, on a bright background. Throws CalibrationError (BadInput) if the board needs more tags
// than the dictionary has, or if the dictionary is unknown.
std::vector<PaintedBox> boardSquares(const Board& board, const TagPrint& print);

// A straight edge between ink and paper, along x or y.
struct PrintedEdge {
  Eigen::Vector2d from_m = Eigen::Vector2d::Zero(), to_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d paper = Eigen::Vector2d::UnitX();  // unit normal, from the ink to the paper
  double ink_m = 0.0, paper_m = 0.0;                 // to the nearest parallel edge on either side

  double length_m() const { return (to_m - from_m).norm(); }
};

// The same rectangles as cells between lines, each of ink or of paper. Beyond them there is paper.
class PrintedPattern {
 public:
  PrintedPattern(const Board& board, const TagPrint& print);

  bool isInk(const Eigen::Vector2d& at_m) const;
  // Disjoint boxes of ink that cover all of it.
  std::vector<PaintedBox> inkBoxes() const;
  // Each as long as its ink is on the same side: at a corner between two dark squares, edges end.
  std::vector<PrintedEdge> edges() const;

 private:
  int columns() const { return static_cast<int>(x_m_.size()) - 1; }
  int rows() const { return static_cast<int>(y_m_.size()) - 1; }
  bool inkAt(int column, int row) const;
  void addEdges(bool vertical, std::vector<PrintedEdge>& edges) const;

  std::vector<double> x_m_, y_m_;  // the lines between cells, ascending
  std::vector<bool> ink_;          // by cell, row by row
};

}  // namespace evical
