// The printable target, true to scale, as SVG and as PDF: the circles, a margin around them, and below them a
// ruler of 100 mm with which a print is checked.
#pragma once

#include "core/geometry/circle_board.h"

#include <string>

namespace evical {

// Margin from the outer circles' edges to the sheet's. Throws CalibrationError (BadInput) for a board that
// makes no sense, or one too large for a PDF page (5 m).
std::string boardSvg(const CircleBoard& board, double margin_m);
std::string boardPdf(const CircleBoard& board, double margin_m);

}  // namespace evical
