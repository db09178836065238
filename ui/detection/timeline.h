// SPDX-License-Identifier: GPL-3.0-or-later
// Timeline of the whole recording: outcome of each window, event rate and angular rate of the camera. Click
// or drag sets the time; wheel zooms, shift+wheel or the middle button pans; left and right step by windows;
// Home and End; a double click shows everything.
#pragma once

#include "core/data/board_observations.h"
#include "ui/detection/event_window_reader.h"

#include <QBrush>
#include <QColor>
#include <QPixmap>
#include <QRectF>
#include <QWidget>

#include <array>
#include <optional>
#include <vector>

class QPainter;

namespace evical::ui {

enum class WindowClass { Complete, Partial, Rejected, Missed };
inline constexpr std::size_t kWindowClassCount = 4;
WindowClass windowClass(WindowOutcome outcome);
QColor windowColour(WindowClass window_class);  // of the theme
QBrush windowBrush(WindowClass window_class);   // partial ones are dotted
double endOfWindow(const WindowReport& window);

class Timeline : public QWidget {
  Q_OBJECT

 public:
  explicit Timeline(QWidget* parent = nullptr);

  void setRange(double begin_s, double end_s);  // of the whole recording
  // Used part of the recording, if it is not the whole.
  void setUsedRange(const std::optional<std::array<double, 2>>& range_s);
  void setWindows(std::vector<WindowReport> windows);  // in any order
  void setEventRate(RateCurve events_s);
  void setRotationRate(RateCurve rad_s);

  double begin_s() const { return begin_s_; }
  double end_s() const { return end_s_; }
  const std::optional<std::array<double, 2>>& usedRange_s() const { return used_s_; }
  double time_s() const { return time_s_; }
  const std::vector<WindowReport>& windows() const { return windows_; }
  // Window that contains a time.
  std::optional<WindowReport> windowAt(double time_s) const;
  // Middle of the next window (+1) or the previous one (-1); without windows, 10 ms further.
  double stepFrom(double time_s, int direction) const;
  // Middle of the next or previous missed window; none if there is none.
  std::optional<double> missedFrom(double time_s, int direction) const;

  void showAll();
  void zoomBy(double factor, double about_s);
  double visibleBegin_s() const { return visible_begin_s_; }
  double visibleEnd_s() const { return visible_end_s_; }
  double xOf(double time_s) const;
  double timeOf(double x) const;

  QSize sizeHint() const override { return {700, 135}; }
  QSize minimumSizeHint() const override { return {300, 100}; }

 public slots:
  void setTime(double time_s);  // moves the cursor without a signal

 signals:
  void timeSelected(double time_s);  // by the user

 protected:
  void paintEvent(QPaintEvent*) override;
  bool event(QEvent*) override;
  void wheelEvent(QWheelEvent*) override;
  void mousePressEvent(QMouseEvent*) override;
  void mouseMoveEvent(QMouseEvent*) override;
  void mouseReleaseEvent(QMouseEvent*) override;
  void mouseDoubleClickEvent(QMouseEvent*) override;
  void keyPressEvent(QKeyEvent*) override;

 private:
  using ColumnCounts = std::array<int, kWindowClassCount>;  // by WindowClass

  void select(double time_s);
  void scrollBy(double shift_s);
  std::vector<WindowReport>::const_iterator firstEndingAfter(double time_s) const;
  QRectF curveArea() const;
  QRectF tickArea() const;
  std::vector<ColumnCounts> countColumns() const;
  void paintHeader(QPainter& painter) const;
  void paintAxis(QPainter& painter) const;
  void paintCurve(QPainter& painter, const RateCurve& curve, double top, const QColor& colour,
                  bool filled) const;
  void paintCurves(QPainter& painter);
  void paintTicks(QPainter& painter) const;
  void paintUnused(QPainter& painter) const;
  void paintCursor(QPainter& painter) const;

  double begin_s_ = 0.0, end_s_ = 0.0;
  double visible_begin_s_ = 0.0, visible_end_s_ = 0.0;
  double time_s_ = 0.0;
  std::optional<std::array<double, 2>> used_s_;
  std::vector<WindowReport> windows_;  // by time
  RateCurve event_rate_, rotation_rate_;
  double event_top_ = 1.0, rotation_top_ = 1.0;  // ends of the curves' axes
  // Cache of the last drawing: a run moves the cursor and adds windows many times a second, while the curves
  // stay.
  struct CurvePicture {
    QPixmap picture;
    QSize size;
    double begin_s = 0.0, end_s = 0.0;
    bool dark = false;
  };
  CurvePicture curves_;
  std::optional<double> pan_from_x_;
  bool scrubbing_ = false;
};

}  // namespace evical::ui
