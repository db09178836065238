// SPDX-License-Identifier: GPL-3.0-or-later
// Follows a recording that another program is still writing: offers it, checks it again as it grows, and
// makes all pages read it again at its end.
#pragma once

#include "ui/window/pages.h"

namespace evical::ui {

struct Workbench;

void wireFollowing(const Pages& pages, Workbench& workbench);

}  // namespace evical::ui
