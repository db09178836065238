// SPDX-License-Identifier: GPL-3.0-or-later
// A page that shows what only the calibration of a rig brings; while a camera alone is calibrated, it says so.
#pragma once

#include "ui/document/calibration_aim.h"

#include <QStackedWidget>

namespace evical::ui {

class RigPage : public QStackedWidget {
  Q_OBJECT

 public:
  // `what`: what the page shows, as the subject of a sentence.
  RigPage(QWidget* page, const QString& what, QWidget* parent);

  void setAim(CalibrationAim aim);

 signals:
  void rigRequested();
};

}  // namespace evical::ui
