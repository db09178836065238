// SPDX-License-Identifier: GPL-3.0-or-later
// Content and speed of a plot's drawing.
#include "tests/support/processor_time.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/plot_hands.h"
#include "tests/ui/plot_pictures.h"
#include "ui/theme/theme.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestPlotDrawing : public QObject {
  Q_OBJECT

 private slots:
  void init() { evical::test::setPalette(false); }

  void spike_ofOneSampleIsSeenAmongThreeHundredThousand();
  void longLines_areDrawnFluently_data();
  void longLines_areDrawnFluently();
  void colours_followThePalette();
  void equalScale_holdsAtEverySize();
  void equalScale_comesBackToWhatWasChosen();
  void logarithmicAxis_leavesOutWhatIsNotPositive();
  void points_areDrawnSmallAndLarge_data();
  void points_areDrawnSmallAndLarge();
  void manyPoints_areDrawnFluently();
  void cells_differByTheirValues();
  void picture_isWorthLookingAt();
};

void TestPlotDrawing::spike_ofOneSampleIsSeenAmongThreeHundredThousand() {
  constexpr int kCount = 300'000;
  PlotPanel panel(kTime);
  std::vector<double> x(kCount), y(kCount, 0.0);
  for (std::size_t k = 0; k < kCount; ++k) x[k] = 1e-3 * static_cast<double>(k);
  y[123'456] = 1.0;
  panel.setData(panel.addSeries(Kind::Line, {.name = "spike", .colour = PlotColour::Bad}), x, y);
  panel.resize(1000, 400);
  panel.show();
  panel.fit();
  panel.redraw();
  const QPoint top = panel.pixelAt(123.456, 0.9).toPoint();
  QVERIFY(pixelsLike(panel.grab().toImage(), theme().bad, QRect(top - QPoint(2, 2), QSize(5, 5))) >= 4);
}

void TestPlotDrawing::longLines_areDrawnFluently_data() {
  QTest::addColumn<int>("count");
  QTest::addColumn<double>("rate_hz");
  QTest::newRow("30 s at 1 kHz, three axes") << 30'000 << 1000.0;
  QTest::newRow("300 k samples, three axes") << 300'000 << 10'000.0;
}

void TestPlotDrawing::longLines_areDrawnFluently() {
  QFETCH(int, count);
  QFETCH(double, rate_hz);
  PlotPanel panel(kTime);
  addImuAxes(panel, count, rate_hz);
  panel.resize(1600, 450);
  panel.show();
  panel.fit();
  panel.redraw();
  std::vector<double> times_ms;
  for (int k = 0; k < 15; ++k) {
    panel.setXRange(0.1 * k, 30.0 - 0.3 * k);
    const double before_ms = 1e3 * evical::test::threadCpu_s();
    panel.redraw();
    times_ms.push_back(1e3 * evical::test::threadCpu_s() - before_ms);
  }
  const double min_ms = *std::min_element(times_ms.begin(), times_ms.end());
  QVERIFY2(min_ms < 33.0 * slowness(),
           qPrintable(QStringLiteral("%1 ms, 30 frames/s are fluid").arg(min_ms)));
}

void TestPlotDrawing::colours_followThePalette() {
  PlotPanel panel(kTime);
  fillWithLine(panel);
  const QPoint empty = panel.pixelAt(2.2, 8.2).toPoint();
  QVERIFY(near(panel.grab().toImage().pixelColor(empty), theme().panel));
  const QColor light = theme().panel;
  evical::test::setPalette(true);
  QVERIFY(!near(theme().panel, light));
  QCoreApplication::processEvents();
  QVERIFY(near(panel.grab().toImage().pixelColor(empty), theme().panel));
}

void TestPlotDrawing::equalScale_holdsAtEverySize() {
  PlotPanel panel({.title = "Scatter", .x_label = "x (px)", .y_label = "y (px)", .equal_scale = true});
  fillWithLine(panel);
  for (const QSize size : {QSize(700, 300), QSize(300, 700), QSize(500, 500)}) {
    panel.resize(size);
    panel.redraw();
    const QPointF origin = panel.pixelAt(0.0, 0.0), x = panel.pixelAt(5.0, 0.0), y = panel.pixelAt(0.0, 5.0);
    QVERIFY2(std::abs((x.x() - origin.x()) - (origin.y() - y.y())) <= 2.0,
             qPrintable(QString::number(size.width())));
  }
}

void TestPlotDrawing::equalScale_comesBackToWhatWasChosen() {
  PlotPanel panel({.title = "Scatter", .x_label = "x (px)", .y_label = "y (px)", .equal_scale = true});
  fillWithLine(panel);
  panel.redraw();
  const auto x = panel.xRange(), y = panel.yRange();
  for (const QSize size : {QSize(900, 250), QSize(250, 900), QSize(60, 60), QSize(600, 400)}) {
    panel.resize(size);
    panel.redraw();
  }
  QVERIFY(std::abs(panel.xRange().first - x.first) < 0.3 && std::abs(panel.xRange().second - x.second) < 0.3);
  QVERIFY(std::abs(panel.yRange().first - y.first) < 0.3 && std::abs(panel.yRange().second - y.second) < 0.3);
}

void TestPlotDrawing::logarithmicAxis_leavesOutWhatIsNotPositive() {
  PlotPanel panel(
      {.title = "Cost", .x_label = "iteration", .y_label = "cost", .logarithmic_y = true, .whole_x = true});
  panel.setData(panel.addSeries(Kind::Line, {.name = "cost"}), {0, 1, 2, 3}, {1e6, 1e3, 0.0, 10.0});
  panel.fit();
  QVERIFY(panel.yRange().first > 1.0 && panel.yRange().first < 10.0);
  QVERIFY(panel.yRange().second > 1e6);
}

void TestPlotDrawing::points_areDrawnSmallAndLarge_data() {
  QTest::addColumn<double>("width_px");
  QTest::newRow("small") << 2.0;
  QTest::newRow("large") << 6.0;
}

void TestPlotDrawing::points_areDrawnSmallAndLarge() {
  QFETCH(double, width_px);
  PlotPanel panel(kTime);
  fillWithLine(panel);
  panel.setData(panel.addSeries(Kind::Points, {.name = "p", .colour = PlotColour::Bad, .width_px = width_px}),
                {2.0}, {8.0});
  panel.redraw();
  const QRect around(panel.pixelAt(2.0, 8.0).toPoint() - QPoint(4, 4), QSize(9, 9));
  const int drawn = pixelsLike(panel.grab().toImage(), theme().bad, around);
  QVERIFY2(drawn >= 0.5 * width_px * width_px, qPrintable(QString::number(drawn)));
}

void TestPlotDrawing::manyPoints_areDrawnFluently() {
  constexpr int kCount = 15'000;
  std::vector<double> x, y;
  unsigned state = 1;
  const auto next = [&state] { return (state = state * 1664525u + 1013904223u) / 4294967296.0 - 0.5; };
  for (int k = 0; k < kCount; ++k) {
    x.push_back(next() + next() + next());
    y.push_back(next() + next() + next());
  }
  PlotPanel panel({.title = "Scatter", .x_label = "x (px)", .y_label = "y (px)", .equal_scale = true});
  panel.setData(panel.addSeries(Kind::Points, {.name = "p", .width_px = 2.0, .opacity = 0.6}), x, y);
  panel.resize(820, 430);
  panel.show();
  panel.fit();
  panel.redraw();
  double min_ms = 1e9;
  for (int k = 0; k < 10; ++k) {
    const double before_ms = 1e3 * evical::test::threadCpu_s();
    panel.redraw();
    min_ms = std::min(min_ms, 1e3 * evical::test::threadCpu_s() - before_ms);
  }
  qInfo("%.1f ms", min_ms);
  QVERIFY2(min_ms < 33.0 * slowness(), qPrintable(QString::number(min_ms)));
}

void TestPlotDrawing::cells_differByTheirValues() {
  constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();
  PlotPanel panel({.title = "Cells", .x_label = "x (px)", .y_label = "y (px)"});
  panel.setCells({QRectF(0.0, 0.0, 3.0, 2.0), 3, 2, {kOpen, 1.0, 10.0, kOpen, 1.0, 10.0}},
                 PlotColour::Accent);
  panel.resize(600, 400);
  panel.show();
  panel.fit();
  panel.redraw();
  QVERIFY(panel.xRange().first <= 0.0 && panel.xRange().second >= 3.0);
  QVERIFY(panel.yRange().first <= 0.0 && panel.yRange().second >= 2.0);
  const QImage image = panel.grab().toImage();
  const auto blueness = [&](double x) {
    const QColor colour = image.pixelColor(panel.pixelAt(x, 0.4).toPoint());
    return colour.blue() - colour.red();
  };
  QVERIFY(std::abs(blueness(0.55)) < 5);
  QVERIFY(blueness(1.45) > 10);
  QVERIFY(blueness(2.55) > blueness(1.45) + 40);
}

void TestPlotDrawing::picture_isWorthLookingAt() {
  PlotPanel panel(kTime);
  const Samples middle = noisySine(30'000, 1000.0, 0.0);
  std::vector<double> low, high;
  for (const double y : middle.y) {
    low.push_back(y - 0.3);
    high.push_back(y + 0.3);
  }
  panel.setBand(panel.addSeries(Kind::Band, {.colour = PlotColour::X, .opacity = 0.2}), middle.x, low, high);
  addImuAxes(panel, 30'000, 1000.0);
  panel.setMarks(std::vector<PlotMark>{{10.0, "stage 2"}, {20.0, "stage 3"}});
  panel.setNote("30 000 samples");
  panel.show();
  evical::test::takePictures(panel, "plot_panel", [&] {
    panel.fit();
    QCoreApplication::processEvents();
    panel.setCursorLine(12.0);
    hover(panel, panel.pixelAt(4.0, 0.5));
  });
}

EVICAL_TEST(TestPlotDrawing)
#include "tst_plot_drawing.moc"
