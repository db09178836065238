// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pipeline/view_rejection.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"
#include "tests/ui/plot_pictures.h"
#include "tests/ui/slowdown.h"
#include "ui/plots/plot_panel.h"
#include "ui/plots/residual_statistics.h"
#include "ui/plots/residuals_screen.h"

#include <QDoubleSpinBox>
#include <QPushButton>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr int kSpoiltView = 40;

std::vector<CircleResidual> normalResiduals(int count, double sigma_px, const Eigen::Vector2d& mean_px) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::vector<CircleResidual> residuals;
  for (int k = 0; k < count; ++k) {
    CircleResidual residual;
    residual.view = k / 10;
    residual.time_s = 0.02 * residual.view;
    residual.centre_px = {10.0 + k % 300, 10.0 + (k / 7) % 200};
    residual.residual_px = mean_px + sigma_px * Eigen::Vector2d(normal(engine), normal(engine));
    residual.sigma_px = Eigen::Vector2d::Constant(sigma_px);
    residuals.push_back(residual);
  }
  return residuals;
}

const CameraIntrinsics kUndistorted{
    CameraModel::PinholeRadtan, {320, 240}, {260.0, 260.0}, {160.0, 120.0}, {}};

}  // namespace

class TestResidualsScreen : public QObject {
  Q_OBJECT

  test::SimulatedPass simulated_;
  std::shared_ptr<const CalibrationRun> run_;

  void fill(ResidualsScreen& screen) {
    screen.resize(1000, 650);
    screen.show();
    QSignalSpy ready(&screen, &ResidualsScreen::ready);
    screen.setRun(run_, simulated_.session);
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
  void statistics_ofNormalResidualsAreThoseOfTheirDistribution();
  void statistics_findTheBiasOfACell();
  void statistics_countEachWindowOnItsOwn();
  void ellipse_holdsItsShare();
  void withoutARun_itSaysWhatToDo();
  void threshold_marksTheSpoiltWindowOnly();
  void threshold_draggedInTheChartIsTheSpinBoxs();
  void rejecting_improvesTheCalibration();
  void click_onABarSelectsItsTime();
  void pictures();
};

void TestResidualsScreen::initTestCase() {
  test::setPalette(false);
  simulated_ = test::simulatePass(5.0);
  for (CircleObservation& circle : simulated_.pass.cameras[0].views[kSpoiltView].circles)
    circle.centre_px += Eigen::Vector2d(0.1, circle.circle % 2 == 0 ? 0.12 : -0.12);
  run_ = std::make_shared<CalibrationRun>(calibrate(simulated_.session, simulated_.pass, {}));
}

void TestResidualsScreen::statistics_ofNormalResidualsAreThoseOfTheirDistribution() {
  const ResidualStatistics s =
      residualStatistics(normalResiduals(20'000, 0.1, {0.02, -0.01}), 0, kUndistorted);
  QVERIFY((s.mean_px - Eigen::Vector2d(0.02, -0.01)).norm() < 0.004);
  QVERIFY((s.covariance_px2 - 0.01 * Eigen::Matrix2d::Identity()).norm() < 5e-4);
  QVERIFY(std::abs(s.normalised_mean - 0.05) < 0.02);
  QVERIFY(std::abs(s.normalised_std - 1.0) < 0.03);
  const double mass = s.bin_width * std::accumulate(s.bin_density.begin(), s.bin_density.end(), 0.0);
  QVERIFY(std::abs(mass - 1.0) < 1e-3);
  const auto peak = std::max_element(s.bin_density.begin(), s.bin_density.end()) - s.bin_density.begin();
  QVERIFY(std::abs(s.bin_middle[static_cast<std::size_t>(peak)]) < 0.5);
  QVERIFY(std::abs(s.bin_density[static_cast<std::size_t>(peak)] - 0.399) < 0.03);
}

void TestResidualsScreen::statistics_findTheBiasOfACell() {
  std::vector<CircleResidual> residuals = normalResiduals(3000, 0.01, {0.0, 0.0});
  for (CircleResidual& residual : residuals)
    if (residual.centre_px.x() < 20.0) residual.residual_px.y() += 0.5;
  const ResidualStatistics s = residualStatistics(residuals, 0, kUndistorted);
  QCOMPARE(s.columns, 16);
  QCOMPARE(s.rows, 12);
  int count = 0;
  for (const auto& cell : s.cells) {
    count += cell.count;
    if (cell.count < 5) continue;
    const Eigen::Vector2d expected(0.0, cell.middle_px.x() < 20.0 ? 0.5 : 0.0);
    QVERIFY((cell.mean_px - expected).norm() < 0.02);
  }
  QCOMPARE(count, 3000);
}

void TestResidualsScreen::statistics_countEachWindowOnItsOwn() {
  std::vector<CircleResidual> residuals = normalResiduals(40, 0.1, {0.0, 0.0});
  for (std::size_t k = 10; k < 20; ++k) residuals[k].residual_px = {3.0, 4.0};
  for (std::size_t k = 20; k < 30; ++k) residuals[k].used = false;
  residuals[39].camera = 1;
  const ResidualStatistics s = residualStatistics(residuals, 0, kUndistorted);
  QCOMPARE(s.windows.size(), std::size_t{3});
  QCOMPARE(s.windows[1].view, 1);
  QVERIFY(std::abs(s.windows[1].rms_px - 5.0) < 1e-12);
  QCOMPARE(s.windows[2].view, 3);
  QCOMPARE(s.windows[2].circles, 9);
  QCOMPARE(s.dropped.size(), std::size_t{10});
}

void TestResidualsScreen::ellipse_holdsItsShare() {
  const ResidualStatistics s = residualStatistics(normalResiduals(20'000, 0.1, {0.3, 0.0}), 0, kUndistorted);
  const auto ellipse = sigmaEllipse(s.mean_px, s.covariance_px2, 2.0);
  for (const Eigen::Vector2d& point : ellipse) QVERIFY(std::abs((point - s.mean_px).norm() - 0.2) < 0.01);
}

void TestResidualsScreen::withoutARun_itSaysWhatToDo() {
  ResidualsScreen screen;
  screen.show();
  QVERIFY(!screen.findChild<QPushButton*>()->isVisible());
  QVERIFY(screen.rejectedWindows().empty());
  fill(screen);
  QVERIFY(screen.findChild<QPushButton*>()->isVisible());
  screen.setRun(nullptr, {});
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
  const auto circles = simulated_.pass.cameras[0].views[kSpoiltView].circles.size();
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
  const RecordingPass kept = withoutViews(run_->pass, 0, screen.rejectedWindows());
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

void TestResidualsScreen::pictures() {
  ResidualsScreen screen;
  fill(screen);
  screen.setThreshold(0.11);
  screen.setTime(2.0);
  QTest::qWait(100);
  test::takePictures(screen, "residuals", settle);
}

EVICAL_TEST(TestResidualsScreen)
#include "tst_residuals_screen.moc"
