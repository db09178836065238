// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/test_program.h"
#include "tests/ui/screenshots.h"
#include "ui/detection/timeline.h"
#include "ui/theme/theme.h"

#include <QSignalSpy>
#include <QTest>
#include <QWheelEvent>

#include <cmath>

using namespace evical;
using namespace evical::ui;

namespace {

WindowReport window(double time_s, WindowOutcome outcome) {
  WindowReport report;
  report.time_s = time_s;
  report.half_width_s = 0.05;
  report.outcome = outcome;
  return report;
}

// Ten seconds, a window every tenth: the first half complete, then partial, the last second missed.
std::vector<WindowReport> hundredWindows() {
  std::vector<WindowReport> windows;
  for (int k = 0; k < 100; ++k) {
    windows.push_back(window(0.05 + 0.1 * k, k < 50   ? WindowOutcome::Complete
                                             : k < 90 ? WindowOutcome::Partial
                                                      : WindowOutcome::NoLattice));
  }
  return windows;
}

void fill(Timeline& timeline) {
  timeline.resize(1000, 132);
  timeline.setRange(0.0, 10.0);
  timeline.setWindows(hundredWindows());
}

void wheelForTimeline(Timeline& timeline, double x, int steps, Qt::KeyboardModifiers modifiers = {}) {
  const QPointF at(x, 50.0);
  QWheelEvent event(at, timeline.mapToGlobal(at), {}, {0, 120 * steps}, Qt::NoButton, modifiers,
                    Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&timeline, &event);
}

QPoint at(const Timeline& timeline, double time_s) {
  return {static_cast<int>(std::lround(timeline.xOf(time_s))), 50};
}

}  // namespace

class TestTimeline : public QObject {
  Q_OBJECT

 private slots:
  void click_selectsTheTimeUnderIt() {
    Timeline timeline;
    fill(timeline);
    QSignalSpy selected(&timeline, &Timeline::timeSelected);
    QTest::mouseClick(&timeline, Qt::LeftButton, {}, at(timeline, 4.0));
    QCOMPARE(selected.size(), 1);
    QVERIFY(std::abs(selected.last().at(0).toDouble() - 4.0) < 0.02);  // a pixel is 11 ms
  }

  void drag_scrubsAndStaysInTheRecording() {
    Timeline timeline;
    fill(timeline);
    timeline.show();
    QSignalSpy selected(&timeline, &Timeline::timeSelected);
    QTest::mousePress(&timeline, Qt::LeftButton, {}, at(timeline, 2.0));
    QTest::mouseMove(&timeline, at(timeline, 3.0));
    QTest::mouseMove(&timeline, {5000, 50});
    QTest::mouseRelease(&timeline, Qt::LeftButton, {}, {5000, 50});
    QCOMPARE(selected.size(), 3);
    QVERIFY(std::abs(selected.at(1).at(0).toDouble() - 3.0) < 0.02);
    QCOMPARE(timeline.time_s(), 10.0);
  }

  void setTime_saysNothing() {
    Timeline timeline;
    fill(timeline);
    QSignalSpy selected(&timeline, &Timeline::timeSelected);
    timeline.setTime(3.0);
    QCOMPARE(timeline.time_s(), 3.0);
    QVERIFY(selected.isEmpty());
  }

  void keys_goFromWindowToWindow() {
    Timeline timeline;
    fill(timeline);
    timeline.setTime(1.01);
    QTest::keyClick(&timeline, Qt::Key_Right);
    QVERIFY(std::abs(timeline.time_s() - 1.05) < 1e-9);
    QTest::keyClick(&timeline, Qt::Key_Right);
    QVERIFY(std::abs(timeline.time_s() - 1.15) < 1e-9);
    QTest::keyClick(&timeline, Qt::Key_Left);
    QVERIFY(std::abs(timeline.time_s() - 1.05) < 1e-9);
    QTest::keyClick(&timeline, Qt::Key_End);
    QCOMPARE(timeline.time_s(), 10.0);
    QTest::keyClick(&timeline, Qt::Key_Home);
    QCOMPARE(timeline.time_s(), 0.0);
    QTest::keyClick(&timeline, Qt::Key_Left);
    QCOMPARE(timeline.time_s(), 0.0);
  }

  void wheel_zoomsAboutTheMouseAndDoubleClickShowsAll() {
    Timeline timeline;
    fill(timeline);
    const double x = timeline.xOf(7.0);
    wheelForTimeline(timeline, x, 5);
    QVERIFY(timeline.visibleEnd_s() - timeline.visibleBegin_s() < 3.0);
    QVERIFY(std::abs(timeline.timeOf(x) - 7.0) < 1e-6);
    const double begin_s = timeline.visibleBegin_s();
    wheelForTimeline(timeline, x, 1, Qt::ShiftModifier);
    QVERIFY(timeline.visibleBegin_s() < begin_s);
    QTest::mouseDClick(&timeline, Qt::LeftButton, {}, at(timeline, 7.0));
    QCOMPARE(timeline.visibleBegin_s(), 0.0);
    QCOMPARE(timeline.visibleEnd_s(), 10.0);
  }

  void windowAt_knowsItsLimits() {
    Timeline timeline;
    fill(timeline);
    QVERIFY(std::abs(timeline.windowAt(1.02)->time_s - 1.05) < 1e-9);
    QVERIFY(!timeline.windowAt(10.2).has_value());
    QVERIFY(!timeline.windowAt(-0.2).has_value());
  }

  void ticks_areToldApart_byColourAndByShape() {
    Timeline timeline;
    fill(timeline);
    const QImage image = timeline.grab().toImage();
    const int low = timeline.height() - 25, high = timeline.height() - 32;
    // Two columns, since dots are in every second one.
    const auto inkAt = [&](double time_s, int top, const QColor& colour) {
      int count = 0;
      const int x = at(timeline, time_s).x();
      for (int y = top; y < top + 4; ++y)
        count += (image.pixelColor(x, y) == colour) + (image.pixelColor(x + 1, y) == colour);
      return count;
    };
    QCOMPARE(inkAt(2.54, low, theme().good), 8);
    QCOMPARE(inkAt(2.54, high, theme().good), 0);
    const int dots = inkAt(7.04, low, theme().warning);
    QVERIFY2(dots >= 2 && dots <= 6, qPrintable(QString::number(dots)));
    QCOMPARE(inkAt(9.54, low, theme().bad), 8);
    QVERIFY(inkAt(9.54, high, theme().bad) >= 4);  // it protrudes
  }

  // One window of two thousand has half a pixel.
  void missedWindow_isWideEnoughToBeSeen() {
    Timeline timeline;
    timeline.resize(1000, 132);
    timeline.setRange(0.0, 10.0);
    std::vector<WindowReport> windows;
    for (int k = 0; k < 2000; ++k) {
      windows.push_back(
          window(0.0025 + 0.005 * k, k == 800 ? WindowOutcome::NoLattice : WindowOutcome::Complete));
      windows.back().half_width_s = 0.0025;
    }
    timeline.setWindows(windows);
    const QImage image = timeline.grab().toImage();
    const int x = at(timeline, windows[800].time_s).x(), y = timeline.height() - 31;  // near the row's top
    int columns = 0;
    for (int k = x - 10; k <= x + 10; ++k) columns += image.pixelColor(k, y) == theme().bad ? 1 : 0;
    QCOMPARE(columns, 4);
  }

  void unusedParts_areFaded() {
    Timeline timeline;
    fill(timeline);
    const auto tickAt = [&](double time_s) {
      const QImage picture = timeline.grab().toImage();
      return picture.pixelColor(at(timeline, time_s).x(), timeline.height() - 25);
    };
    QCOMPARE(tickAt(2.03), windowColour(WindowClass::Complete));
    timeline.setUsedRange({{3.0, 8.0}});
    QVERIFY(tickAt(2.03) != windowColour(WindowClass::Complete));
    QCOMPARE(tickAt(4.03), windowColour(WindowClass::Complete));
    QVERIFY(tickAt(8.53) != windowColour(WindowClass::Partial));
    timeline.setUsedRange({});
    QCOMPARE(tickAt(2.03), windowColour(WindowClass::Complete));
  }

  void windows_mayComeInAnyOrder() {
    Timeline timeline;
    std::vector<WindowReport> windows;
    for (const double time_s : {0.3, 0.1, 0.2}) windows.push_back(window(time_s, WindowOutcome::Complete));
    timeline.setWindows(windows);
    QCOMPARE(timeline.windows().size(), std::size_t{3});
    QCOMPARE(timeline.windows().front().time_s, 0.1);
    QCOMPARE(timeline.windows().back().time_s, 0.3);
  }

  void picture_inBothThemes_data() {
    QTest::addColumn<bool>("dark");
    QTest::newRow("light") << false;
    QTest::newRow("dark") << true;
  }
  void picture_inBothThemes() {
    QFETCH(bool, dark);
    QApplication::setPalette(dark ? QPalette(QColor(45, 49, 56), QColor(31, 34, 39)) : QPalette());
    Timeline timeline;
    fill(timeline);
    RateCurve events, rotation;
    for (int k = 0; k < 1000; ++k) {
      events.values.push_back(static_cast<float>(1e6 * (1.0 + std::sin(0.02 * k))));
      rotation.values.push_back(static_cast<float>(std::abs(1.4 * std::sin(0.013 * k))));
    }
    timeline.setEventRate(events);
    timeline.setRotationRate(rotation);
    timeline.setTime(3.21);
    QVERIFY(timeline.grab().save(
        evical::ui::test::screenshotPath("timeline_%1.png").arg(dark ? "dark" : "light")));
    QApplication::setPalette(QPalette());
  }
};

EVICAL_TEST(TestTimeline)
#include "tst_timeline.moc"
