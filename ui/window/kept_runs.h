// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of the session that is open: each is kept as soon as it is there, and the list of them opens and compares
// them.
#pragma once

namespace evical::ui {

class ResultScreen;
class RunsPanel;
struct Workbench;

void wireRuns(RunsPanel& panel, ResultScreen& result, Workbench& workbench);

}  // namespace evical::ui
