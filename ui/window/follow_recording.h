// SPDX-License-Identifier: GPL-3.0-or-later
// A recording that another program is still writing: it is offered to be followed, looked through again as it grows, and
// read anew by all pages when its end has come.
#pragma once

#include "ui/window/pages.h"

namespace evical::ui {

struct Workbench;

void wireFollowing(const Pages& pages, Workbench& workbench);

}  // namespace evical::ui
