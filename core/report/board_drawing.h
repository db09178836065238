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

}  // namespace evical
