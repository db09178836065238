// SPDX-License-Identifier: GPL-3.0-or-later
// What screens show while a camera alone is calibrated, and its result.
#pragma once

class QObject;

namespace evical::ui {

class LensFiles;
struct Pages;
struct Workbench;

// After the other pages' connections: what a camera alone shows comes after what a rig shows.
void wireLensPages(const Pages& pages, Workbench& workbench, LensFiles& files);

}  // namespace evical::ui
