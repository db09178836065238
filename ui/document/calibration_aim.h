// SPDX-License-Identifier: GPL-3.0-or-later
// What is calibrated: all of a rig, or one camera's lens alone.
#pragma once

namespace evical::ui {

enum class CalibrationAim { Rig, Camera };

}  // namespace evical::ui
