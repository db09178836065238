// SPDX-License-Identifier: GPL-3.0-or-later
// A few rules that modernise Fusion. Everything else follows the palette.
#pragma once

#include "ui/theme/theme.h"

#include <QString>

namespace evical::ui {

// Frames with the property `card` are panels, labels with the property `role` are titles, hints or problems.
QString styleSheetOf(const Theme& theme);

}  // namespace evical::ui
