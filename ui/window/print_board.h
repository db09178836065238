// SPDX-License-Identifier: GPL-3.0-or-later
// What comes before a recording: a board to print, and how to move before it. Windows of their own, beside the work.
#pragma once

#include <QString>

class QWidget;

namespace evical::ui {

struct Workbench;

void showPrintBoard(QWidget* window, Workbench& workbench);
void showHowToRecord(QWidget* window, const QString& motion = {});  // that is shown first

}  // namespace evical::ui
