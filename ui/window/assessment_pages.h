// SPDX-License-Identifier: GPL-3.0-or-later
// The pages that check a result, follow IMUs over time, and compare several recordings: their jobs, default
// paths and files.
#pragma once

class QWidget;

namespace evical::ui {

class MaintainScreen;
class MaintenanceCharts;
class RepeatScreen;
class ResultCheckScreen;
class SessionFiles;
struct Workbench;

void wireResultCheck(ResultCheckScreen& screen, Workbench& workbench, SessionFiles& files);
void wireMaintain(MaintainScreen& screen, MaintenanceCharts& charts, Workbench& workbench,
                  SessionFiles& files);
void wireRepeat(RepeatScreen& screen, Workbench& workbench, SessionFiles& files);

// Proposals for the old result: the shown run, then the stored runs; and the dialogs that choose one.

class OldResultRow;

void wireOldResult(OldResultRow& row, QWidget& page, Workbench& workbench);

}  // namespace evical::ui
