// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/verdict_icon.h"

#include "ui/theme/theme.h"

namespace evical::ui {

QIcon verdictIcon(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::Ok:
      return icon("done", theme().good);
    case CalibrationStatus::Doubtful:
      return icon("warning", theme().warning);
    case CalibrationStatus::Failed:
      break;
  }
  return icon("error", theme().bad);
}

}  // namespace evical::ui
