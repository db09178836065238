// SPDX-License-Identifier: GPL-3.0-or-later
// Check whether the recording is good enough: its job, its card, and the condition for "ready".
#pragma once

class QAction;
class QObject;

namespace evical::ui {

class RecordingScreen;
struct Workbench;

void wireRecordingCheck(RecordingScreen& screen, Workbench& workbench);

// Disables and enables the check; the state is stored in the settings.
QAction* makeCheckAction(Workbench& workbench, QObject* parent);

}  // namespace evical::ui
