// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/plot_pictures.h"
#include "tests/ui/slowdown.h"
#include "ui/plots/plot_panel.h"
#include "ui/plots/signals_screen.h"

#include <QComboBox>
#include <QTabWidget>

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::ui;

class TestSignalsScreen : public QObject {
  Q_OBJECT

  evical::test::SimulatedPass simulated_;
  std::shared_ptr<const CalibrationRun> run_;

  void fill(SignalsScreen& screen) {
    QSignalSpy ready(&screen, &SignalsScreen::ready);
    screen.setRun(run_, simulated_.session);
    QVERIFY(ready.wait(30'000 * kSlowdown));
  }
  static void settle() {
    for (int k = 0; k < 3; ++k) QCoreApplication::processEvents();
  }

 private slots:
  void initTestCase() {
    evical::test::setPalette(false);
    simulated_ = evical::test::simulatePass(6.0);
    run_ = std::make_shared<CalibrationRun>(calibrate(simulated_.session, simulated_.detections, {}));
  }

  void withoutARun_itSaysWhatToDo() {
    SignalsScreen screen;
    screen.show();
    QVERIFY(!screen.findChild<QTabWidget*>()->isVisible());
    fill(screen);
    QVERIFY(screen.findChild<QTabWidget*>()->isVisible());
    screen.setRun(nullptr, {});
    QVERIFY(!screen.findChild<QTabWidget*>()->isVisible());
  }

  void setRun_doesNotHoldUpTheWindow() {
    SignalsScreen screen;
    QSignalSpy ready(&screen, &SignalsScreen::ready);
    const double begin_s = evical::test::threadCpu_s();
    screen.setRun(run_, simulated_.session);
    QVERIFY2(evical::test::threadCpu_s() - begin_s < 0.05 * evical::ui::test::slowness(),
             "it copies the session and starts a thread");
    QCOMPARE(ready.count(), 0);
    QVERIFY(ready.wait(30'000 * kSlowdown));
  }

  void setRun_twiceShowsTheLatter() {
    SignalsScreen screen;
    auto shorter = std::make_shared<CalibrationRun>(*run_);
    shorter->detections.imus[0].samples.resize(2000);
    QSignalSpy ready(&screen, &SignalsScreen::ready);
    screen.setRun(run_, simulated_.session);
    screen.setRun(shorter, simulated_.session);
    QVERIFY(ready.wait(30'000 * kSlowdown));
    QVERIFY(screen.findChild<PlotPanel*>("gyroscope")->xRange().second < 2.1);
    QTest::qWait(50);
    QCOMPARE(ready.count(), 1);
  }

  void signals_areOnTheCamerasClock() {
    SignalsScreen screen;
    fill(screen);
    const QStringList first =
        screen.findChild<PlotPanel*>("gyroscope")->csv().split('\n')[1].split(',');  // x measured
    const double camera_s = first[1].toDouble();
    const double offset_s = timeOffsetAt_s(run_->result.state.cameras[0], camera_s);
    QVERIFY(std::abs(offset_s) > 5e-3);
    const auto& samples = run_->detections.imus[0].samples;
    const auto sample = std::find_if(samples.begin(), samples.end(), [&](const ImuSample& s) {
      return std::abs(static_cast<double>(s.time_ns - run_->detections.start_ns) * 1e-9 - offset_s -
                      camera_s) < 1e-6;
    });
    QVERIFY(sample != samples.end());
    QVERIFY(std::abs(sample->angular_rate_rad_s.x() - first[2].toDouble()) < 1e-6);
  }

  // Drawn over each other, the last one would hide the others.
  void residuals_haveARowEach_andTheirNoiseIsNamed() {
    SignalsScreen screen;
    screen.resize(1000, 650);
    screen.show();
    fill(screen);
    settle();
    int rows = 0;
    for (const PlotPanel* const panel : screen.findChildren<PlotPanel*>())
      rows += panel->isVisible() && panel->csv().section('\n', 1, 1).count(',') == 2 &&
              panel->objectName() != "gyroscope";
    QCOMPARE(rows, 3);
  }

  void spectrum_isOfTheNoiseThatWasSimulated() {
    SignalsScreen screen;
    fill(screen);
    screen.findChild<QComboBox*>("below")->setCurrentIndex(1);
    const QStringList lines =
        screen.findChild<QWidget*>("gyroscope_tab")->findChild<PlotPanel*>("spectrum")->csv().split('\n');
    const double given = run_->detections.imus[0].noise.gyroscope_density;
    int points = 0, near = 0;
    for (const QString& line : lines.mid(1)) {
      const QStringList values = line.split(',');
      if (values.size() != 3 || values[1].toDouble() < 20.0) continue;
      ++points;
      near += std::abs(std::log(values[2].toDouble() / given)) < std::log(1.7);
    }
    QVERIFY(points > 100);
    QVERIFY2(near > 0.9 * points, qPrintable(QString("%1 of %2").arg(near).arg(points)));
  }

  void click_selectsTheTimeForAll() {
    SignalsScreen screen;
    screen.resize(1000, 650);
    screen.show();
    fill(screen);
    settle();
    QSignalSpy selected(&screen, &SignalsScreen::timeSelected);
    PlotPanel& signal = *screen.findChild<PlotPanel*>("gyroscope");
    QWidget* const chart = signal.findChild<QWidget*>();
    QTest::mouseClick(chart, Qt::LeftButton, Qt::NoModifier,
                      chart->mapFromParent(signal.pixelAt(2.5, 0.0).toPoint()));
    QCOMPARE(selected.count(), 1);
    QVERIFY(std::abs(selected[0][0].toDouble() - 2.5) < 0.02);
  }

  void setTime_bringsTheTimeIntoView() {
    SignalsScreen screen;
    fill(screen);
    PlotPanel& signal = *screen.findChild<PlotPanel*>("gyroscope");
    signal.setXRange(1.0, 2.0);
    screen.setTime(1.5);
    QCOMPARE(signal.xRange(), std::pair(1.0, 2.0));
    screen.setTime(4.0);
    QCOMPARE(signal.xRange(), std::pair(3.5, 4.5));
  }

  void pictures() {
    SignalsScreen screen;
    screen.show();
    fill(screen);
    screen.setTime(2.0);
    auto* const tabs = screen.findChild<QTabWidget*>();
    const char* const names[] = {"signals_gyroscope", "signals_accelerometer", "signals_rates"};
    for (int tab = 0; tab < 3; ++tab) {
      tabs->setCurrentIndex(tab);
      evical::test::takePictures(screen, names[tab], settle);
    }
    tabs->setCurrentIndex(0);
    screen.findChild<QComboBox*>("below")->setCurrentIndex(1);
    evical::test::takePictures(screen, "signals_spectrum", settle);
    screen.findChild<QComboBox*>("below")->setCurrentIndex(2);
    evical::test::takePictures(screen, "signals_autocorrelation", settle);
  }
};

EVICAL_TEST(TestSignalsScreen)
#include "tst_signals_screen.moc"
