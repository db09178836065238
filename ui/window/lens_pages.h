// SPDX-License-Identifier: GPL-3.0-or-later
// Content of the screens during the calibration of a camera alone, and its result.
#pragma once

class QObject;

namespace evical::ui {

class LensFiles;
struct Pages;
struct Workbench;

// Call after the other pages are wired: the slots for a camera alone must run after those for a rig.
void wireLensPages(const Pages& pages, Workbench& workbench, LensFiles& files);

}  // namespace evical::ui
