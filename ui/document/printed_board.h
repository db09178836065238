// SPDX-License-Identifier: GPL-3.0-or-later
// The last printed board and its measured length: default for recordings that are opened afterwards. Stored
// in the program's settings.
#pragma once

#include "core/geometry/board.h"

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
std::optional<PrintedBoard> lastPrintedBoard();  // none if none was printed, or the stored one is invalid

// Sets the first of the session's boards.
void setPrintedBoard(const PrintedBoard& printed, Session& session);

}  // namespace evical::ui
