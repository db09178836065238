// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pipeline/detection/view_rejection.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"
#include "tests/ui/plot_pictures.h"
#include "tests/ui/slowdown.h"
#include "ui/plots/plot_panel.h"
#include "ui/plots/residuals_screen.h"

#include <QDoubleSpinBox>
#include <QPushButton>

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr int kSpoiltView = 40;

}  // namespace

class TestResidualsScreen : public QObject {
  Q_OBJECT

  evical::test::SimulatedPass simulated_;
  std::shared_ptr<const CalibrationRun> run_;

  void fill(ResidualsScreen& screen) {
    screen.resize(1000, 650);
    screen.show();
    QSignalSpy ready(&screen, &ResidualsScreen::ready);
    screen.setRun(run_);
    QVERIFY(ready.wait(30'000 * kSlowdown));
    settle();
  }
  static void settle() {
    for (int k = 0; k < 3; ++k) QCoreApplication::processEvents();
  }
  static PlotPanel& windows(ResidualsScreen& screen) {
    for (PlotPanel* panel : screen.findChildren<PlotPanel*>())
      if (panel->threshold()) return *panel;
    qFatal("no chart has a threshold");
  }
  static int markedPoints(ResidualsScreen& screen) {
    for (PlotPanel* panel : screen.findChildren<PlotPanel*>()) {
      const QString csv = panel->csv();
      if (csv.contains("sigma")) return static_cast<int>(csv.count("\nmarked,"));
    }
    return -1;
  }

 private slots:
  void initTestCase();
  void withoutARun_itSaysWhatToDo();
  void threshold_marksTheSpoiltWindowOnly();
  void threshold_draggedInTheChartIsTheSpinBoxs();
  void rejecting_improvesTheCalibration();
  void click_onABarSelectsItsTime();
  void manyPoints_areThinned();
  void pictures();
};

void TestResidualsScreen::initTestCase() {
  evical::test::setPalette(false);
  simulated_ = evical::test::simulatePass(5.0);
  for (CircleObservation& circle : simulated_.detections.cameras[0].views[kSpoiltView].circles)
    circle.centre_px += Eigen::Vector2d(0.1, circle.circle % 2 == 0 ? 0.12 : -0.12);
  run_ = std::make_shared<CalibrationRun>(calibrate(simulated_.session, simulated_.detections, {}));
}

void TestResidualsScreen::withoutARun_itSaysWhatToDo() {
  ResidualsScreen screen;
  screen.show();
  QVERIFY(!screen.findChild<QPushButton*>()->isVisible());
  QVERIFY(screen.rejectedWindows().empty());
  fill(screen);
  QVERIFY(screen.findChild<QPushButton*>()->isVisible());
  screen.setRun(nullptr);
  QVERIFY(!screen.findChild<QPushButton*>()->isVisible());
  QVERIFY(screen.rejectedWindows().empty());
}

void TestResidualsScreen::threshold_marksTheSpoiltWindowOnly() {
  ResidualsScreen screen;
  fill(screen);
  auto* const button = screen.findChild<QPushButton*>();
  QVERIFY(!button->isEnabled());  // nothing is marked at first
  QCOMPARE(markedPoints(screen), 0);
  QSignalSpy changed(&screen, &ResidualsScreen::thresholdChanged);
  screen.setThreshold(0.11);
  QCOMPARE(changed.count(), 1);
  QCOMPARE(changed[0][0].toDouble(), 0.11);
  QCOMPARE(screen.rejectedWindows(), std::vector<int>{kSpoiltView});
  QTRY_VERIFY(button->isEnabled());
  const auto circles = simulated_.detections.cameras[0].views[kSpoiltView].circles.size();
  QCOMPARE(markedPoints(screen), static_cast<int>(circles));
  QSignalSpy recalibrate(&screen, &ResidualsScreen::recalibrateWithout);
  QTest::mouseClick(button, Qt::LeftButton);
  QCOMPARE(recalibrate.count(), 1);
  QCOMPARE(recalibrate[0][0].value<std::vector<int>>(), std::vector<int>{kSpoiltView});
  QCOMPARE(screen.camera(), 0);
}

void TestResidualsScreen::threshold_draggedInTheChartIsTheSpinBoxs() {
  ResidualsScreen screen;
  fill(screen);
  PlotPanel& chart_panel = windows(screen);
  const double before = screen.threshold_px();
  QWidget* const chart = chart_panel.findChild<QWidget*>();
  const auto at = [&](double y) { return chart->mapFromParent(chart_panel.pixelAt(2.0, y).toPoint()); };
  QTest::mousePress(chart, Qt::LeftButton, Qt::NoModifier, at(before));
  const QPointF to = at(0.5 * before);
  QMouseEvent move(QEvent::MouseMove, to, chart->mapToGlobal(to), Qt::NoButton, Qt::LeftButton,
                   Qt::NoModifier);
  QApplication::sendEvent(chart, &move);
  QTest::mouseRelease(chart, Qt::LeftButton, Qt::NoModifier, at(0.5 * before));
  QVERIFY(std::abs(screen.threshold_px() - 0.5 * before) < 0.03 * before);
  QCOMPARE(screen.findChild<QDoubleSpinBox*>()->value(), screen.threshold_px());
  screen.findChild<QDoubleSpinBox*>()->setValue(0.1);
  QCOMPARE(*chart_panel.threshold(), 0.1);
}

void TestResidualsScreen::rejecting_improvesTheCalibration() {
  ResidualsScreen screen;
  fill(screen);
  screen.setThreshold(0.11);
  const DetectionResult kept = withoutViews(run_->detections, 0, screen.rejectedWindows());
  const CalibrationRun again = calibrate(simulated_.session, kept, {});
  QVERIFY(again.result.cameras[0].reprojection_rms_px < run_->result.cameras[0].reprojection_rms_px);
}

void TestResidualsScreen::click_onABarSelectsItsTime() {
  ResidualsScreen screen;
  fill(screen);
  PlotPanel& chart_panel = windows(screen);
  QWidget* const chart = chart_panel.findChild<QWidget*>();
  QSignalSpy selected(&screen, &ResidualsScreen::timeSelected);
  QTest::mouseClick(chart, Qt::LeftButton, Qt::NoModifier,
                    chart->mapFromParent(chart_panel.pixelAt(2.0, 0.02).toPoint()));
  QCOMPARE(selected.count(), 1);
  QVERIFY(std::abs(selected[0][0].toDouble() - 2.0) < 0.03);
}

void TestResidualsScreen::manyPoints_areThinned() {
  ResidualsScreen screen;
  fill(screen);
  const auto scatter = [&] {
    for (PlotPanel* const panel : screen.findChildren<PlotPanel*>())
      if (panel->title() == "Residuals") return panel;
    qFatal("no such chart");
  };
  QVERIFY(scatter()->toolTip().startsWith("Wheel: zoom"));
  auto many = std::make_shared<CalibrationRun>(*run_);
  std::vector<CircleResidual>& residuals = many->result.circle_residuals;
  while (residuals.size() < 20'000) {
    const std::vector<CircleResidual> once = residuals;
    residuals.insert(residuals.end(), once.begin(), once.end());
  }
  QSignalSpy ready(&screen, &ResidualsScreen::ready);
  screen.setRun(many);
  QVERIFY(ready.wait(30'000 * kSlowdown));
  QVERIFY2(scatter()->toolTip().startsWith("One of "), qPrintable(scatter()->toolTip()));
}

void TestResidualsScreen::pictures() {
  ResidualsScreen screen;
  fill(screen);
  screen.setThreshold(0.11);
  screen.setTime(2.0);
  QTest::qWait(100);
  evical::test::takePictures(screen, "residuals", settle);
}

EVICAL_TEST(TestResidualsScreen)
#include "tst_residuals_screen.moc"
