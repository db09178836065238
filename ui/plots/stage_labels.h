// SPDX-License-Identifier: GPL-3.0-or-later
// Stages of the optimisation as text.
#pragma once

#include "core/data/calibration_result.h"

#include <QString>

#include <vector>

namespace evical::ui {

struct StageWords {
  QString name;  // "Stage 2: + 1 quantity"
  QString help;  // "Stage 2: + gyroscope scale and misalignment"
};
std::vector<StageWords> stageWords(const std::vector<IterationRecord>& iterations);

QString stagesHelp();  // reason for the jump of the cost between stages
QString neededHelp();  // lines and bands in the charts of parameters

}  // namespace evical::ui
