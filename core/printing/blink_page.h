// A page that flashes the board on a screen, for the intrinsics of event cameras: one HTML file that needs no network.
// It asks for a length on the screen, and says what the session must say of the board.
#pragma once

#include "core/geometry/board.h"
#include "core/printing/board_squares.h"

#include <string>

namespace evical {

// The board is shown as large as the screen allows, with this margin at the board's own size. Throws CalibrationError
// (BadInput) as boardSvg does.
std::string blinkPage(const Board& board, double margin_m, const TagPrint& print = {});

}  // namespace evical
