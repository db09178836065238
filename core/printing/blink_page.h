// Page that flashes the board on a screen, for the intrinsics of event cameras: one HTML file that needs no
// network. The user measures a length on the screen; the page shows the board's entry for the session.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/printed_pattern.h"

#include <string>

namespace evical {

// The board is shown as large as the screen allows, with this margin at the board's own size. Throws
// CalibrationError (BadInput) as boardSvg does.
std::string blinkPage(const Board& board, double margin_m, const TagPrint& print = {});

}  // namespace evical
