// SPDX-License-Identifier: GPL-3.0-or-later
// The board that was printed last, with what was measured of it: recordings that are opened afterwards show it, most
// likely. Kept with the program's settings.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/measured_length.h"

#include <optional>

namespace evical {
struct Session;
}

namespace evical::ui {

struct PrintedBoard {
  Board board;
  std::optional<MeasuredLength> measured;
};

void rememberPrintedBoard(const PrintedBoard& printed);
std::optional<PrintedBoard> lastPrintedBoard();  // nothing where none was, or what is kept makes no board

// As the first of the session's boards.
void setPrintedBoard(const PrintedBoard& printed, Session& session);

}  // namespace evical::ui
