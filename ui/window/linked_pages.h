// SPDX-License-Identifier: GPL-3.0-or-later
// Screens that show a run, during and after it, with a common time cursor.
#pragma once

namespace evical::ui {

struct Pages;
struct Workbench;

void wireLinkedPages(const Pages& pages, Workbench& workbench);

}  // namespace evical::ui
