// SPDX-License-Identifier: GPL-3.0-or-later
// Icon of a verdict, distinct by colour and by shape.
#pragma once

#include "core/data/calibration_status.h"

#include <QIcon>

namespace evical::ui {

QIcon verdictIcon(CalibrationStatus status);

}  // namespace evical::ui
