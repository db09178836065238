// SPDX-License-Identifier: GPL-3.0-or-later
// Reprojection residuals: scatter with sigma ellipses, histogram with the normal distribution, RMS of each
// window with a threshold that marks windows for rejection, and coverage and mean residuals over the sensor.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"

#include <QWidget>

#include <memory>
#include <vector>

class QComboBox;
class QDoubleSpinBox;
class QHBoxLayout;
class QLabel;
class QPushButton;
class QStackedLayout;
class QTimer;
class QToolButton;

namespace evical {

struct ResidualStatistics;
struct WindowResidual;
}  // namespace evical

namespace evical::ui {

class LatestJob;
class PlotPanel;

class ResidualsScreen : public QWidget {
  Q_OBJECT

 public:
  explicit ResidualsScreen(QWidget* parent = nullptr);
  ~ResidualsScreen() override;

  // Null: empty. Charts are computed in a thread and shown when ready.
  void setRun(std::shared_ptr<const CalibrationRun> run);
  void setCalibrating(bool calibrating);  // a calibration is running

  int camera() const;                        // shown camera
  std::vector<int> rejectedWindows() const;  // views of that camera above the threshold, ascending
  double threshold_px() const;
  void setThreshold(double rms_px);

 public slots:
  void setTime(double time_s);  // seconds since the recording's start, camera clock

 signals:
  void timeSelected(double time_s);              // the middle of a window
  void windowWanted(int camera, double time_s);  // to be shown
  void thresholdChanged(double rms_px);
  void recalibrateWithout(
      const std::vector<int>& views);  // of camera(); see core/pipeline/detection/view_rejection.h
  void ready();                        // all charts show the last set run

 private:
  void showNote();
  QWidget* makeContent();
  QWidget* makeBar();
  void makeScatter();
  void makeWindows();
  void compute();
  void draw();
  void drawScatter();
  void drawHistogram();
  void drawWindows();
  void drawImagePlane();
  void markRejected();
  void markTime();
  void selectNearest(double x_px, double y_px);
  void selectView(int view);
  double viewTime_s(int view) const;
  const WindowResidual* windowAtCursor() const;  // null: none

  std::shared_ptr<const CalibrationRun> run_;
  bool calibrating_ = false;
  std::shared_ptr<const ResidualStatistics> statistics_;
  LatestJob* job_;
  QTimer* mark_soon_;
  double time_s_ = -1.0;
  PlotPanel *scatter_ = nullptr, *histogram_ = nullptr, *windows_ = nullptr, *image_ = nullptr;
  struct ScatterSeries {
    std::size_t used, dropped, rejected, now, ellipses[3];
  } scatter_series_ = {};
  struct WindowSeries {
    std::size_t kept, rejected;
  } window_series_ = {};
  QStackedLayout* stack_ = nullptr;
  QComboBox* camera_ = nullptr;
  QDoubleSpinBox* threshold_ = nullptr;
  QLabel *camera_label_ = nullptr, *count_ = nullptr;
  QToolButton* show_window_ = nullptr;
  QString scatter_help_;  // without the share of drawn points
  QPushButton* recalibrate_ = nullptr;
};

}  // namespace evical::ui
