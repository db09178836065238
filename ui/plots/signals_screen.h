// SPDX-License-Identifier: GPL-3.0-or-later
// Measured IMU signals and their prediction by the calibrated trajectory, with the residuals below, by axis,
// as spectrum or as autocorrelation; and the rotation rates of camera and IMU, before and after the time
// offset. All on the camera's clock.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

#include <QWidget>

#include <array>
#include <memory>
#include <vector>

class QComboBox;
class QLabel;
class QStackedLayout;
class QTabWidget;

namespace evical::ui {

class LatestJob;
class PlotPanel;
class SignalTab;

class SignalsScreen : public QWidget {
  Q_OBJECT

 public:
  explicit SignalsScreen(QWidget* parent = nullptr);

  // Null: empty. Charts are computed in a thread and shown when ready.
  void setRun(std::shared_ptr<const CalibrationRun> run, const Session& session);
  void setCalibrating(bool calibrating);  // a calibration is running

 public slots:
  void setTime(double time_s);  // seconds since the recording's start, camera clock

 signals:
  void timeSelected(double time_s);
  void ready();  // all charts show the last set run

 private:
  void showNote();
  struct Drawing;
  SignalTab* addSignalTab(const QString& title, SignalTab* tab);
  QWidget* makeRatesTab();
  QWidget* makeBar();
  PlotPanel* addPanel(const QString& title, const QString& unit);
  void addToTime(PlotPanel* panel);
  void compute();
  void draw(const Drawing& drawing);

  std::shared_ptr<const CalibrationRun> run_;
  bool calibrating_ = false;
  Session session_;
  LatestJob* job_;
  std::vector<PlotPanel*> panels_;
  SignalTab *gyroscope_ = nullptr, *accelerometer_ = nullptr;
  PlotPanel *before_ = nullptr, *after_ = nullptr, *difference_ = nullptr;
  QStackedLayout* stack_ = nullptr;
  QTabWidget* tabs_ = nullptr;
  QComboBox *camera_ = nullptr, *imu_ = nullptr, *below_ = nullptr;
  QLabel *camera_label_ = nullptr, *imu_label_ = nullptr;
};

}  // namespace evical::ui
