// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of the open session: each is stored when it is done; the list opens and compares them.
#pragma once

namespace evical::ui {

class ResultScreen;
class RunsPanel;
struct Workbench;

void wireRuns(RunsPanel& panel, ResultScreen& result, Workbench& workbench);

}  // namespace evical::ui
