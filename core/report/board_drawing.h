// The printable target, true to scale, as SVG and as PDF: the circles, squares or tags, a margin around them, and
// below them a ruler of 100 mm with which a print is checked.
#pragma once

#include "core/geometry/board.h"
#include "core/report/board_squares.h"

#include <string>

namespace evical {

// Margin from the outermost edges to the sheet's. Throws CalibrationError (BadInput) for a board that
// makes no sense, or one too large for a PDF page (5 m).
std::string boardSvg(const Board& board, double margin_m, const TagPrint& print = {});
std::string boardPdf(const Board& board, double margin_m, const TagPrint& print = {});

// The board alone, without ruler and words: elements of SVG in millimetres, for pages that put more around it. What
// they do not paint is meant to be white.
struct BoardPicture {
  double width_mm = 0.0, height_mm = 0.0;
  std::string elements;
};
BoardPicture boardPicture(const Board& board, double margin_m, const TagPrint& print = {});

}  // namespace evical
