// SPDX-License-Identifier: GPL-3.0-or-later
// One IMU of the session: name, noise densities with presets, units.
#pragma once

#include "core/pipeline/session/session.h"

#include <QWidget>

class QComboBox;
class QFormLayout;
class QLineEdit;

namespace evical::ui {

class NumberField;

class ImuForm : public QWidget {
  Q_OBJECT

 public:
  explicit ImuForm(QWidget* parent = nullptr);

  void setImu(const SessionImu& imu);

 signals:
  void edited(const evical::SessionImu& imu, const QString& field);

 private:
  void say(const QString& field);
  void usePreset(int index);

  SessionImu imu_;
  QFormLayout* form_;
  QLineEdit* name_;
  QComboBox* preset_;
  NumberField *gyroscope_, *accelerometer_, *clock_offset_s_;
  QComboBox *angular_rate_unit_, *acceleration_unit_;
};

}  // namespace evical::ui
