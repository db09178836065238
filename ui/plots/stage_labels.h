// SPDX-License-Identifier: GPL-3.0-or-later
// What the stages of the optimisation do, in words.
#pragma once

#include "core/data/calibration_result.h"

#include <QString>
#include <QStringList>

#include <vector>

namespace evical::ui {

// One a stage: "Stage 2: + gyroscope scale and misalignment".
QStringList stageLines(const std::vector<IterationRecord>& iterations);

QString stagesHelp();  // why cost jumps where a stage begins
QString neededHelp();  // lines and bands of parameters

}  // namespace evical::ui
