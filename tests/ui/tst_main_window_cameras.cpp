// SPDX-License-Identifier: GPL-3.0-or-later
// A session of two cameras in the real window: each page with a choice of camera shows the data of that
// camera.
#include "ui/window/main_window.h"

#include "tests/support/test_program.h"
#include "tests/ui/screenshots.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_engine.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/event_view.h"
#include "ui/detection/timeline.h"
#include "ui/detection/window_analysis.h"
#include "ui/plots/plot_panel.h"
#include "ui/plots/residuals_screen.h"
#include "ui/plots/signals_screen.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/recording/stream_table.h"
#include "ui/screens/result/result_screen.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"

#include <QComboBox>
#include <QElapsedTimer>
#include <QLabel>
#include <QSet>
#include <QTabWidget>
#include <QTemporaryDir>
#include <QTreeWidget>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

// The control that lists the cameras; it is visible if there is more than one.
QComboBox* cameraBox(QWidget* screen) {
  for (QComboBox* const box : screen->findChildren<QComboBox*>()) {
    if (box->count() == 2 && box->itemText(0) == "left" && box->itemText(1) == "right") return box;
  }
  return nullptr;
}

void choose(QComboBox* box, int index) {
  box->setFocus();
  QTest::keyClick(box, index > box->currentIndex() ? Qt::Key_Down : Qt::Key_Up);
  QCOMPARE(box->currentIndex(), index);
}

// Mean position of the circles that the front end found in the picture.
QPointF middleOf(const WindowAnalysis& analysis) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& circle : analysis.trace().circles) sum += circle.centre_px;
  sum /= static_cast<double>(analysis.trace().circles.size());
  return {sum.x(), sum.y()};
}

}  // namespace

class TestMainWindowCameras : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  std::unique_ptr<WindowFixture> test_;

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    test_ = std::make_unique<WindowFixture>();
    test_->window.files().open(simulatedTwoCameraSession());
    QCOMPARE(test_->document().session().cameras.size(), std::size_t{2});
  }
  void cleanupTestCase() { test_.reset(); }

  void recording_hasATabForEach() {
    const auto camerasListed = [&] {
      const StreamTable* const streams = test_->child<StreamTable>();
      int cameras = 0;
      for (int row = 0; row < streams->rowCount(); ++row) cameras += streams->role(row) == StreamRole::Camera;
      return cameras;
    };
    QTRY_COMPARE_WITH_TIMEOUT(camerasListed(), 2, kPatience_ms);  // each is in a separate file
    QStringList tabs;
    for (QTabWidget* const widget : test_->child<RecordingScreen>()->findChildren<QTabWidget*>()) {
      for (int k = 0; k < widget->count(); ++k) tabs << widget->tabText(k);
    }
    QVERIFY2(tabs.contains("left") && tabs.contains("right"), qPrintable(tabs.join(' ')));
  }

  void calibration_findsBoth() {
    test_->press(Qt::Key_F5);
    QCOMPARE(test_->waitForJob(), JobOutcome::Done);
    const CalibrationRun& run = *test_->document().last().run;
    QCOMPARE(run.result.state.cameras.size(), std::size_t{2});
    QCOMPARE(run.detections.cameras.size(), std::size_t{2});
    const RigidTransform right_from_left = inverse(run.result.state.cameras[1].reference_from_camera) *
                                           run.result.state.cameras[0].reference_from_camera;
    QVERIFY(std::abs(right_from_left.translation_m.norm() - 0.1) < 0.02);
  }

  // The board is where the other camera, 0.1 m to the side, sees it.
  void detection_showsTheChosenCamera() {
    test_->window.showScreen("detection");
    auto* const screen = test_->child<DetectionScreen>();
    QTRY_VERIFY_WITH_TIMEOUT(cameraBox(screen) && cameraBox(screen)->isVisible(), kPatience_ms);
    QComboBox* const box = cameraBox(screen);
    const double time_s = commonWindow_s();
    const QPointF left = boardAt(*screen, time_s, 0);
    choose(box, 1);
    const QPointF right = boardAt(*screen, time_s, 1);
    QVERIFY2(std::abs(left.x() - right.x()) + std::abs(left.y() - right.y()) > 10.0, "the same picture");
    choose(box, 0);
    const QPointF again = boardAt(*screen, time_s, 0);
    QVERIFY(std::abs(left.x() - again.x()) + std::abs(left.y() - again.y()) < 0.5);
  }

  void detection_timelineIsTheChosenCamerasOwn() {
    auto* const screen = test_->child<DetectionScreen>();
    QComboBox* const box = cameraBox(screen);
    const CalibrationRun& run = *test_->document().last().run;
    for (const int camera : {1, 0}) {
      choose(box, camera);
      const auto& windows = run.detections.cameras[static_cast<std::size_t>(camera)].windows;
      const WindowReport& wanted = windows.at(windows.size() / 2);
      const auto shown = screen->timeline().windowAt(wanted.time_s);
      QVERIFY(shown);
      QCOMPARE(shown->time_s, wanted.time_s);
      QCOMPARE(shown->outcome, wanted.outcome);
    }
  }

  // Live windows of a camera that is not selected must not appear.
  void live_followsTheChosenCamera() {
    test_->window.showScreen("detection");
    auto* const screen = test_->child<DetectionScreen>();
    choose(cameraBox(screen), 1);
    test_->press(Qt::Key_F5);
    QTRY_VERIFY_WITH_TIMEOUT(screen->isLive() && screen->analysis(), kPatience_ms);
    QCOMPARE(cameraBox(screen)->currentIndex(), 1);
    QCOMPARE(test_->waitForJob(), JobOutcome::Done);
    QCOMPARE(cameraBox(screen)->currentIndex(), 1);
    choose(cameraBox(screen), 0);
  }

  // The other camera's picture is the one that it shows when selected.
  void detection_showsBothCamerasSideBySide() {
    test_->window.showScreen("detection");
    auto* const screen = test_->child<DetectionScreen>();
    const double time_s = commonWindow_s();
    boardAt(*screen, time_s, 0);
    QVERIFY(!screen->companionView().isVisible());
    screen->setPicture(PictureChoice::SideBySide);
    const auto beside = [&] { return screen->companionView().frame(); };
    QTRY_VERIFY_WITH_TIMEOUT(
        screen->companionView().isVisible() && beside() && std::abs(beside()->time_s - time_s) < 0.01,
        kPatience_ms);
    QVERIFY(screen->companionView().legend() == ColourLegend::Polarity);
    QTRY_VERIFY_WITH_TIMEOUT(beside()->events > 100, kPatience_ms);
    QTest::qWait(500);  // until its whole recording has been read
    QVERIFY(test_->window.grab().save(screenshotPath("detection_both_cameras.png")));
    const auto other = beside();
    screen->setPicture(PictureChoice::Alone);
    QVERIFY(!screen->companionView().isVisible());
    choose(cameraBox(screen), 1);
    const auto shown = [&] {
      screen->setTime(other->time_s);
      const auto frame = screen->view().frame();
      return frame && frame->time_s == other->time_s && frame->image == other->image;
    };
    QTRY_VERIFY_WITH_TIMEOUT(shown(), kPatience_ms);
    choose(cameraBox(screen), 0);
  }

  void live_showsBothCamerasSideBySide() {
    auto* const screen = test_->child<DetectionScreen>();
    screen->setPicture(PictureChoice::SideBySide);
    test_->press(Qt::Key_F5);
    QSet<const void*> here, beside;
    QElapsedTimer since;
    since.start();
    while (since.elapsed() < kPatience_ms && (here.size() < 3 || beside.size() < 3) &&
           test_->runner().running()) {
      spin(10);
      if (!screen->isLive()) continue;
      here.insert(screen->view().frame().get());
      beside.insert(screen->companionView().frame().get());
    }
    QVERIFY2(here.size() >= 3 && beside.size() >= 3,
             qPrintable(QString("%1 and %2 pictures").arg(here.size()).arg(beside.size())));
    QCOMPARE(test_->waitForJob(), JobOutcome::Done);
    screen->setPicture(PictureChoice::Alone);
  }

  void residuals_areTheChosenCamerasOwn() {
    test_->window.showScreen("residuals");
    auto* const screen = test_->child<ResidualsScreen>();
    QTRY_VERIFY_WITH_TIMEOUT(cameraBox(screen) && cameraBox(screen)->isVisible(), kPatience_ms);
    QComboBox* const box = cameraBox(screen);
    QCOMPARE(screen->camera(), 0);
    QTRY_COMPARE_WITH_TIMEOUT(pointsOf(screen, "sigma", "used"), usedBy(0), kPatience_ms);
    choose(box, 1);
    QCOMPARE(screen->camera(), 1);
    QTRY_COMPARE_WITH_TIMEOUT(pointsOf(screen, "sigma", "used"), usedBy(1), kPatience_ms);
    QVERIFY(usedBy(0) != usedBy(1));
  }

  void signals_areTheChosenCamerasOwn() {
    test_->window.showScreen("signals");
    auto* const screen = test_->child<SignalsScreen>();
    QTRY_VERIFY_WITH_TIMEOUT(cameraBox(screen) && cameraBox(screen)->isVisible(), kPatience_ms);
    QComboBox* const box = cameraBox(screen);
    QTRY_VERIFY_WITH_TIMEOUT(pointsOf(screen, "camera", "camera") > 10, kPatience_ms);
    const QStringList left = charts(screen);
    choose(box, 1);
    QTRY_VERIFY_WITH_TIMEOUT(charts(screen) != left, kPatience_ms);
    choose(box, 0);
    QTRY_COMPARE_WITH_TIMEOUT(charts(screen), left, kPatience_ms);
  }

  void withoutImu_everyScreenSaysWhatThereIs() {
    Session session = test_->document().session();
    session.imus.clear();
    session.reference = "left";
    test_->document().edit(session, "Leave the IMU out");
    test_->press(Qt::Key_F5);
    QCOMPARE(test_->waitForJob(), JobOutcome::Done);
    const CalibrationRun& run = *test_->document().last().run;
    QVERIFY(run.result.state.imus.empty());
    QVERIFY(std::abs(run.result.state.cameras[1].reference_from_camera.translation_m.norm() - 0.1) < 0.02);
    QVERIFY(!test_->child<StepsPanel>()->findChildren<StepRow*>().isEmpty());
    QVERIFY(test_->child<StepsPanel>()->textOf("gravity and translation").isEmpty());
    QStringList seen;
    for (const QString& name : test_->window.screenNames()) {
      test_->window.showScreen(name);
      spin(200);
      for (const QLabel* const label : test_->window.findChildren<QLabel*>())
        if (label->isVisible()) seen << label->text();
    }
    const QString all = seen.join('|');
    QVERIFY2(all.contains("There is no IMU"), qPrintable(all));
    QVERIFY2(all.contains("Camera position"), qPrintable(all));
    QVERIFY2(!all.contains("IMU position"), qPrintable(all));
    QVERIFY(topLevelTexts().contains("left (reference)"));
    QVERIFY(!topLevelTexts().contains("Gravity"));
    test_->document().undoStack().undo();
  }

  void result_listsBoth() {
    QTRY_VERIFY2(topLevelTexts().contains("left") && topLevelTexts().contains("right"),
                 qPrintable(topLevelTexts()));
  }

 private:
  QString topLevelTexts() const {
    QStringList groups;
    for (QTreeWidget* const tree : test_->child<ResultScreen>()->findChildren<QTreeWidget*>()) {
      for (int k = 0; k < tree->topLevelItemCount(); ++k) groups << tree->topLevelItem(k)->text(0);
    }
    return groups.join('|');
  }

  static QStringList charts(QWidget* screen) {
    QStringList all;
    for (const PlotPanel* const panel : screen->findChildren<PlotPanel*>()) all << panel->csv();
    return all;
  }

  // In the chart that has the series `mark`.
  static int pointsOf(QWidget* screen, const char* mark, const QString& series) {
    for (const QString& csv : charts(screen)) {
      if (csv.contains(mark)) return static_cast<int>(csv.count('\n' + series + ','));
    }
    return -1;
  }

  int usedBy(int camera) const {
    int count = 0;
    for (const CircleResidual& residual : test_->document().last().run->result.circle_residuals)
      count += residual.camera == camera && residual.used ? 1 : 0;
    return count;
  }

  // A time at which both cameras saw the whole board.
  double commonWindow_s() const {
    const auto& cameras = test_->document().last().run->detections.cameras;
    for (const WindowReport& left : cameras[0].windows) {
      for (const WindowReport& right : cameras[1].windows) {
        if (left.outcome == WindowOutcome::Complete && right.outcome == WindowOutcome::Complete &&
            std::abs(left.time_s - right.time_s) < 0.003 && left.time_s > 0.5)
          return left.time_s;
      }
    }
    return 1.0;
  }

  QPointF boardAt(DetectionScreen& screen, double time_s, std::size_t camera) {
    const auto ready = [&] {
      const auto& analysis = screen.analysis();
      return screen.view().frame() && analysis && !analysis->trace().circles.empty() &&
             std::abs(analysis->time_s - time_s) < 1e-6;
    };
    screen.setTime(time_s + 0.2);
    screen.setTime(time_s);
    if (!QTest::qWaitFor(ready, kPatience_ms)) qFatal("no board of camera %zu at %g s", camera, time_s);
    return middleOf(*screen.analysis());
  }
};

EVICAL_TEST(TestMainWindowCameras)
#include "tst_main_window_cameras.moc"
