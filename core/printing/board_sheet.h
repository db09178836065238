// A board laid out on a sheet, in millimetres from its top left corner, y down: what all drawings of it have in
// common.
#pragma once

#include "core/printing/board_drawing.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

struct SheetBox {
  double x_mm = 0.0, y_mm = 0.0, width_mm = 0.0, height_mm = 0.0;
  bool bright = false;
};

struct BoardSheet {
  double width_mm = 0.0, height_mm = 0.0;
  SheetBox field;  // the board with its margins
  double radius_mm = 0.0;
  std::vector<Eigen::Vector2d> centres_mm;
  std::vector<SheetBox> boxes;  // painted in this order
  bool bright_circles = false;  // on a dark field, which is the first box
  SheetBox ruler;
  double caption_x_mm = 0.0, caption_y_mm = 0.0,
         text_size_mm = 0.0;  // where the caption's first letter stands
  std::string caption;
};

// Shortest text that is exact to a thousandth: 50, 49.5, 0.125.
std::string shortNumber(double value);

BoardSheet layOut(const Board& board, const SheetOptions& options, const TagPrint& print);

}  // namespace evical
