// The printable target, true to scale, as SVG, as PDF, and as PNG that states its resolution: the circles, squares or
// tags, a margin around them, and below them a ruler of 100 mm with which a print is checked.
#pragma once

#include "core/geometry/board.h"
#include "core/printing/board_squares.h"

#include <optional>
#include <string>
#include <vector>

namespace evical {

struct Paper {
  std::string name;
  double short_mm = 0.0, long_mm = 0.0;
};
const std::vector<Paper>& papers();  // A0 to A4

struct SheetOptions {
  double margin_m = 0.02;  // from the outermost edges to the sheet's, at least
  std::optional<Paper> paper =
      {};  // upright or lying, as the board fits; absent: as large as the board needs
};

// Throw CalibrationError (BadInput) for a board that makes no sense, for one that the paper is too small for, and for
// one too large for a PDF page (5 m).
std::string boardSvg(const Board& board, const SheetOptions& options = {}, const TagPrint& print = {});
std::string boardPdf(const Board& board, const SheetOptions& options = {}, const TagPrint& print = {});
// Shades of grey: of a pixel on an edge as much as is printed of it.
std::string boardPng(const Board& board, double resolution_dpi, const SheetOptions& options = {},
                     const TagPrint& print = {});

// The board alone, without ruler and words: elements of SVG in millimetres, for pages that put more around it. What
// they do not paint is meant to be white.
struct BoardPicture {
  double width_mm = 0.0, height_mm = 0.0;
  std::string elements;
};
BoardPicture boardPicture(const Board& board, double margin_m, const TagPrint& print = {});

}  // namespace evical
