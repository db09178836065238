// SPDX-License-Identifier: GPL-3.0-or-later
// Screens that show a run, during and after it, with a common time cursor.
#pragma once

#include "ui/window/pages.h"

namespace evical::ui {

struct Pages;
struct Workbench;

// Calibrates the session. Existing detections are used again if nothing that they depend on has changed.
void calibrateRig(Workbench& workbench);

void wireLinkedPages(const Pages& pages, Workbench& workbench);

}  // namespace evical::ui

// Follows a recording that another program is still writing: offers it, checks it again as it grows, and
// makes all pages read it again at its end.

namespace evical::ui {

struct Workbench;

void wireFollowing(const Pages& pages, Workbench& workbench);

}  // namespace evical::ui
