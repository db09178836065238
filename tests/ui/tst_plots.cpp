// SPDX-License-Identifier: GPL-3.0-or-later
// User actions on a plot: zoom, point, hide a curve, save as a file.
#include "tests/support/test_program.h"
#include "tests/ui/plot_hands.h"
#include "tests/ui/plot_pictures.h"
#include "ui/theme/theme.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestPlots : public QObject {
  Q_OBJECT

 private slots:
  void init() { evical::test::setPalette(false); }

  void fit_showsAllDataAndTimeWithoutMargin();
  void wheel_zoomsTimeOnlyAndWithControlTheValues();
  void drag_pansAndIsNoClick();
  void shiftDrag_zoomsIntoTheBox();
  void doubleClick_fits();
  void keys_panZoomAndFit();
  void click_tellsWhere();
  void linkedPanels_shareTheirTime();
  void readout_standsBesideTheMouse();
  void cursor_isDrawnWhereItIsSet();
  void threshold_isDragged();
  void legend_hidesASeries();
  void csv_listsEveryPointOfNamedSeries();
};

void TestPlots::fit_showsAllDataAndTimeWithoutMargin() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  QCOMPARE(panel.xRange(), std::pair(0.0, 10.0));
  QVERIFY(panel.yRange().first < 0.0 && panel.yRange().first > -1.0);
  QVERIFY(panel.yRange().second > 10.0 && panel.yRange().second < 11.0);
}

void TestPlots::wheel_zoomsTimeOnlyAndWithControlTheValues() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  const auto y = panel.yRange();
  wheel(panel, panel.pixelAt(5.0, 5.0));
  QCOMPARE(panel.yRange(), y);
  const auto x = panel.xRange();
  QVERIFY(x.second - x.first < 9.0);
  QVERIFY(std::abs(0.5 * (x.first + x.second) - 5.0) < 0.1);  // the position under the mouse stays
  wheel(panel, panel.pixelAt(5.0, 5.0), Qt::ControlModifier);
  QCOMPARE(panel.xRange(), x);
  QVERIFY(panel.yRange().second < y.second);
}

void TestPlots::drag_pansAndIsNoClick() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  QSignalSpy clicked(&panel, &PlotPanel::clicked);
  drag(panel, panel.pixelAt(5.0, 5.0), panel.pixelAt(7.0, 5.0));
  QVERIFY(std::abs(panel.xRange().first + 2.0) < 0.1);
  QVERIFY(std::abs(panel.xRange().second - 8.0) < 0.1);
  QCOMPARE(clicked.count(), 0);
}

void TestPlots::shiftDrag_zoomsIntoTheBox() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  drag(panel, panel.pixelAt(2.0, 8.0), panel.pixelAt(4.0, 3.0), Qt::ShiftModifier);
  QVERIFY(std::abs(panel.xRange().first - 2.0) < 0.1 && std::abs(panel.xRange().second - 4.0) < 0.1);
  QVERIFY(std::abs(panel.yRange().first - 3.0) < 0.2 && std::abs(panel.yRange().second - 8.0) < 0.2);
}

void TestPlots::doubleClick_fits() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  panel.setXRange(3.0, 4.0);
  QWidget* const chart = panel.findChild<QWidget*>();
  QTest::mouseDClick(chart, Qt::LeftButton, Qt::NoModifier, chart->rect().center());
  QCOMPARE(panel.xRange(), std::pair(0.0, 10.0));
}

void TestPlots::keys_panZoomAndFit() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  QTest::keyClick(&panel, Qt::Key_Plus);
  QVERIFY(panel.xRange().second - panel.xRange().first < 9.0);
  const double low = panel.xRange().first;
  QTest::keyClick(&panel, Qt::Key_Right);
  QVERIFY(panel.xRange().first > low + 0.5);
  QTest::keyClick(&panel, Qt::Key_F);
  QCOMPARE(panel.xRange(), std::pair(0.0, 10.0));
}

void TestPlots::click_tellsWhere() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  QSignalSpy clicked(&panel, &PlotPanel::clicked);
  click(panel, panel.pixelAt(3.0, 6.0));
  QCOMPARE(clicked.count(), 1);
  QVERIFY(std::abs(clicked[0][0].toDouble() - 3.0) < 0.05);
  QVERIFY(std::abs(clicked[0][1].toDouble() - 6.0) < 0.05);
}

void TestPlots::linkedPanels_shareTheirTime() {
  PlotPanel a(kTime), b(kTime), c(kTime);
  PlotPanel::linkX({&a, &b, &c});
  fillWithLine(a);
  fillWithLine(b);
  a.setXRange(2.0, 3.0);
  QCOMPARE(b.xRange(), std::pair(2.0, 3.0));
  QCOMPARE(c.xRange(), std::pair(2.0, 3.0));
  c.setXRange(4.0, 5.0);
  QCOMPARE(a.xRange(), std::pair(4.0, 5.0));
}

void TestPlots::readout_standsBesideTheMouse() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  const QImage before = panel.grab().toImage();
  hover(panel, panel.pixelAt(3.0, 6.0));
  const QImage with = panel.grab().toImage();
  QVERIFY(with != before);
  const QPoint at = panel.pixelAt(3.0, 6.0).toPoint();
  const QRect beside(at + QPoint(14, 12), QSize(60, 14));  // text of the box, right and below
  const auto isDark = [&](const QImage& image) {
    int count = 0;
    for (int y = beside.top(); y <= beside.bottom(); ++y)
      for (int x = beside.left(); x <= beside.right(); ++x) count += image.pixelColor(x, y).lightness() < 140;
    return count;
  };
  QVERIFY(isDark(with) > 10);
  QCOMPARE(isDark(before), 0);
  hover(panel, QPointF(3.0, 3.0));
  QCOMPARE(panel.grab().toImage(), before);
}

void TestPlots::cursor_isDrawnWhereItIsSet() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  panel.setCursorLine(8.0);
  const QPoint at = panel.pixelAt(8.0, 2.0).toPoint();
  const QRect around(at - QPoint(2, 2), QSize(5, 5));
  QVERIFY(pixelsLike(panel.grab().toImage(), theme().accent, around) >= 5);
  panel.setCursorLine(std::nullopt);
  QCOMPARE(pixelsLike(panel.grab().toImage(), theme().accent, around), 0);
}

void TestPlots::threshold_isDragged() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  panel.setThreshold(5.0);
  QSignalSpy dragged(&panel, &PlotPanel::thresholdDragged);
  QSignalSpy clicked(&panel, &PlotPanel::clicked);
  const auto x = panel.xRange();
  drag(panel, panel.pixelAt(2.0, 5.0), panel.pixelAt(3.0, 7.0));
  QVERIFY(dragged.count() > 0);
  QVERIFY(std::abs(*panel.threshold() - 7.0) < 0.1);
  QCOMPARE(dragged.last()[0].toDouble(), *panel.threshold());
  QCOMPARE(panel.xRange(), x);
  QCOMPARE(clicked.count(), 0);
  drag(panel, panel.pixelAt(2.0, 3.0), panel.pixelAt(3.0, 3.0));
  QVERIFY(panel.xRange() != x);  // elsewhere dragging pans
}

void TestPlots::legend_hidesASeries() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  const QPoint on_line = panel.pixelAt(5.0, 5.0).toPoint();
  const QRect around(on_line - QPoint(2, 2), QSize(5, 5));
  QVERIFY(pixelsLike(panel.grab().toImage(), theme().accent, around) >= 3);
  click(panel, QPointF(panel.width() - 22.0, 16.0));
  panel.redraw();
  QCOMPARE(pixelsLike(panel.grab().toImage(), theme().accent, around), 0);
}

void TestPlots::csv_listsEveryPointOfNamedSeries() {
  PlotPanel panel(kTime);
  panel.setData(panel.addSeries(Kind::Line, {.name = "a, measured"}), {0.0, 0.5}, {1.0, -2.0});
  panel.setData(panel.addSeries(Kind::Line, {}), {0.0}, {7.0});
  panel.setBand(panel.addSeries(Kind::Band, {.name = "sigma"}), {0.0}, {-1.0}, {1.0});
  QCOMPARE(panel.csv(), QString("series,time (s),rad/s\n\"a, measured\",0,1\n\"a, measured\",0.5,-2\n"
                                "sigma (low),0,-1\nsigma (high),0,1\n"));
}

EVICAL_TEST(TestPlots)
#include "tst_plots.moc"
