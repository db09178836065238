// SPDX-License-Identifier: GPL-3.0-or-later
// Panels with curves for tests, and simulated mouse actions on them.
#pragma once

#include "ui/plots/plot_panel.h"

#include <QApplication>
#include <QtTest>

#include <cmath>
#include <vector>

namespace evical::ui::test {

using Kind = PlotPanel::SeriesKind;

inline const PlotAxes kTime = {.title = "Gyroscope", .x_label = "time (s)", .y_label = "rad/s", .time = true};
inline constexpr PlotColour kAxisColours[] = {PlotColour::X, PlotColour::Y, PlotColour::Z};

struct Samples {
  std::vector<double> x, y;
};

inline Samples noisySine(int count, double rate_hz, double phase) {
  Samples samples;
  unsigned state = 1;
  for (int k = 0; k < count; ++k) {
    state = state * 1664525u + 1013904223u;
    const double time_s = k / rate_hz;
    samples.x.push_back(time_s);
    samples.y.push_back(std::sin(2.0 * time_s + phase) + 0.2 * (state / 4294967296.0 - 0.5));
  }
  return samples;
}

inline void addImuAxes(PlotPanel& panel, int count, double rate_hz) {
  for (int axis = 0; axis < 3; ++axis) {
    const Samples samples = noisySine(count, rate_hz, axis);
    panel.setData(panel.addSeries(Kind::Line, {.name = QString("xyz"[axis]), .colour = kAxisColours[axis]}),
                  samples.x, samples.y);
  }
}

// Computing time of this thread for a redraw, independent of other load.
inline bool near(const QColor& a, const QColor& b) {
  return std::abs(a.red() - b.red()) + std::abs(a.green() - b.green()) + std::abs(a.blue() - b.blue()) < 60;
}

inline int pixelsLike(const QImage& image, const QColor& colour, const QRect& area) {
  int count = 0;
  for (int y = area.top(); y <= area.bottom(); ++y)
    for (int x = area.left(); x <= area.right(); ++x) count += near(image.pixelColor(x, y), colour);
  return count;
}

inline void wheel(PlotPanel& panel, const QPointF& at, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QWidget* const chart = panel.findChild<QWidget*>();
  const QPointF local = chart->mapFromParent(at.toPoint());
  QWheelEvent event(local, chart->mapToGlobal(local), {}, {0, 120}, Qt::NoButton, modifiers,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(chart, &event);
}

inline void drag(PlotPanel& panel, const QPointF& from, const QPointF& to,
                 Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QWidget* const chart = panel.findChild<QWidget*>();
  const QPoint a = chart->mapFromParent(from.toPoint()), b = chart->mapFromParent(to.toPoint());
  QTest::mousePress(chart, Qt::LeftButton, modifiers, a);
  for (const double part : {0.3, 0.7, 1.0}) {
    const QPointF point = a + part * QPointF(b - a);
    QMouseEvent event(QEvent::MouseMove, point, chart->mapToGlobal(point), Qt::NoButton, Qt::LeftButton,
                      modifiers);
    QApplication::sendEvent(chart, &event);
  }
  QTest::mouseRelease(chart, Qt::LeftButton, modifiers, b);
}

inline void hover(PlotPanel& panel, const QPointF& at) {
  QWidget* const chart = panel.findChild<QWidget*>();
  const QPointF local = chart->mapFromParent(at.toPoint());
  QMouseEvent event(QEvent::MouseMove, local, chart->mapToGlobal(local), Qt::NoButton, Qt::NoButton,
                    Qt::NoModifier);
  QApplication::sendEvent(chart, &event);
}

inline void click(PlotPanel& panel, const QPointF& at) {
  QWidget* const chart = panel.findChild<QWidget*>();
  QTest::mouseClick(chart, Qt::LeftButton, Qt::NoModifier, chart->mapFromParent(at.toPoint()));
}

// One line from (0, 0) to (10, 10).
inline void fillWithLine(PlotPanel& panel) {
  panel.setData(panel.addSeries(Kind::Line, {.name = "line"}), {0.0, 10.0}, {0.0, 10.0});
  panel.resize(600, 400);
  panel.show();
  panel.fit();
  panel.redraw();
}

}  // namespace evical::ui::test
