// SPDX-License-Identifier: GPL-3.0-or-later
// The page that opens logs of IMUs: its job, what is proposed to it, its files.
#pragma once

namespace evical::ui {

class MaintainScreen;
class MaintenanceCharts;
class SessionFiles;
struct Workbench;

void wireMaintain(MaintainScreen& screen, MaintenanceCharts& charts, Workbench& workbench,
                  SessionFiles& files);

}  // namespace evical::ui
