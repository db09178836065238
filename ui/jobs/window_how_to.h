// SPDX-License-Identifier: GPL-3.0-or-later
// Core's messages in the window: of its forms and pages.
#pragma once

#include "core/base/how_to.h"

namespace evical::ui {

const char* windowHowTo(HowTo way);

}  // namespace evical::ui
