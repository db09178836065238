// SPDX-License-Identifier: GPL-3.0-or-later
// Two choices side by side: calibrate the camera, or the rig; and of several cameras, which.
#pragma once

#include "ui/document/calibration_aim.h"

#include <QStringList>
#include <QWidget>

class QComboBox;
class QPushButton;

namespace evical::ui {

class AimChooser : public QWidget {
  Q_OBJECT

 public:
  explicit AimChooser(QWidget* parent = nullptr);

  void setAim(CalibrationAim aim);
  // Asked for while there are several and the aim is one of them.
  void setCameras(const QStringList& names, int chosen);

 signals:
  void aimChosen(evical::ui::CalibrationAim aim);
  void cameraChosen(const QString& name);

 private:
  CalibrationAim aim_ = CalibrationAim::Rig;
  QPushButton *camera_, *rig_;
  QComboBox* cameras_;
};

}  // namespace evical::ui
