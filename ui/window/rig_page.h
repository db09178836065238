// SPDX-License-Identifier: GPL-3.0-or-later
// Wraps a page that is for rigs only; while a camera alone is calibrated, shows a note instead.
#pragma once

#include "ui/document/calibration_aim.h"

#include <QStackedWidget>

namespace evical::ui {

class RigPage : public QStackedWidget {
  Q_OBJECT

 public:
  // `what`: content of the page with its verb, as in "Trajectories belong".
  RigPage(QWidget* page, const QString& what, QWidget* parent);

  void setAim(CalibrationAim aim);

 signals:
  void rigRequested();
};

}  // namespace evical::ui
