// SPDX-License-Identifier: GPL-3.0-or-later
// Choice between two calibrations: a camera or the rig; with several cameras, also which one.
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
  // Shown if there are several and the aim is a camera.
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
