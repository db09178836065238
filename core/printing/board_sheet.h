// Layout of a board on a sheet, in millimetres from the sheet's top left corner, y down. All formats use it.
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
  std::vector<SheetBox> boxes;  // in painting order
  bool bright_circles = false;  // on a dark field, which is the first box
  SheetBox ruler;
  double caption_x_mm = 0.0, caption_y_mm = 0.0,
         text_size_mm = 0.0;  // position of the caption's first letter
  std::string caption;
};

// Shortest text with an error below one thousandth: 50, 49.5, 0.125.
std::string shortNumber(double value);

BoardSheet layOut(const Board& board, const SheetOptions& options, const TagPrint& print);

}  // namespace evical
