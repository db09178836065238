// SPDX-License-Identifier: GPL-3.0-or-later
// The screens that show a run, live and done, and share one cursor in time.
#pragma once

namespace evical::ui {

struct Pages;
struct Workbench;

void wireLinkedPages(const Pages& pages, Workbench& workbench);

}  // namespace evical::ui
