// SPDX-License-Identifier: GPL-3.0-or-later
// Proposals for the old result: the shown run, then the stored runs; and the dialogs that choose one.
#pragma once

class QWidget;

namespace evical::ui {

class OldResultRow;
struct Workbench;

void wireOldResult(OldResultRow& row, QWidget& page, Workbench& workbench);

}  // namespace evical::ui
