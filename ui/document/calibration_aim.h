// SPDX-License-Identifier: GPL-3.0-or-later
// Aim of a calibration: a rig, or the lens of one camera alone.
#pragma once

namespace evical::ui {

enum class CalibrationAim { Rig, Camera };

}  // namespace evical::ui
