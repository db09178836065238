// SPDX-License-Identifier: GPL-3.0-or-later
// Stages of the optimisation as text.
#pragma once

#include "core/data/calibration_result.h"

#include <QString>
#include <QStringList>

#include <vector>

namespace evical::ui {

// One per stage: "Stage 2: + gyroscope scale and misalignment".
QStringList stageLines(const std::vector<IterationRecord>& iterations);

QString stagesHelp();  // reason for the jump of the cost between stages
QString neededHelp();  // lines and bands in the charts of parameters

}  // namespace evical::ui
