// SPDX-License-Identifier: GPL-3.0-or-later
// What is proposed as the old result: the run that is shown, then those that are kept; and the dialogs that choose one.
#pragma once

class QWidget;

namespace evical::ui {

class OldResultRow;
struct Workbench;

void wireOldResult(OldResultRow& row, QWidget& page, Workbench& workbench);

}  // namespace evical::ui
