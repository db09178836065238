// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the recording is good enough: the job that finds out, the card that says it, and what may be called ready.
#pragma once

class QAction;
class QObject;

namespace evical::ui {

class RecordingScreen;
struct Workbench;

void wireRecordingCheck(RecordingScreen& screen, Workbench& workbench);

// Turns it off and on; remembered.
QAction* makeCheckAction(Workbench& workbench, QObject* parent);

}  // namespace evical::ui
