// SPDX-License-Identifier: GPL-3.0-or-later
// Advice of core's messages in terms of the window's forms and pages.
#pragma once

#include "core/base/how_to.h"

namespace evical::ui {

const char* windowHowTo(HowTo way);

}  // namespace evical::ui
