// SPDX-License-Identifier: GPL-3.0-or-later
// Dialogs for the preparation of a recording, not modal: a board to print, and the motions.
#pragma once

#include <QString>

class QWidget;

namespace evical::ui {

struct Workbench;

void showPrintBoard(QWidget* window, Workbench& workbench);
void showHowToRecord(QWidget* window, const QString& motion = {});  // shown first

}  // namespace evical::ui
