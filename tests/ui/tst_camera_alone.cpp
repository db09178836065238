// SPDX-License-Identifier: GPL-3.0-or-later
// Story of a user with a camera that records RAW files without an IMU: open, calibrate the camera, inspect,
// save, use the lens; and the messages if that is not possible.
#include "ui/window/main_window.h"

#include "core/format/intrinsics_yaml.h"
#include "core/geometry/projection_difference.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/packed_events.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/slowdown.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/timeline.h"
#include "ui/screens/lens/lens_screen.h"
#include "ui/screens/recording/aim_chooser.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/result/result_screen.h"
#include "ui/window/error_panel.h"
#include "ui/window/lens_files.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QTreeWidget>

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

Scenario scenario() {
  Scenario read = readScenario(evical::test::scenarioPath("intrinsics_davis346"));
  read.duration_s = 8.0;
  return read;
}

// Like a file of Prophesee's cameras: no IMU, no names, no description of board or lens.
void writeRaw(const Scenario& camera, const QString& path) {
  QFile file(path);
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write("% evt 2.0\n% geometry 346x260\n% end\n");
  std::vector<Event> events;
  simulateEvents(camera, 0,
                 [&](EventSpan packet) { events.insert(events.end(), packet.begin(), packet.end()); });
  const std::string bytes = evical::test::encodeEvt2(events);
  file.write(bytes.data(), static_cast<qint64>(bytes.size()));
}

QString verdictOf(RecordingScreen& screen) {
  for (const QLabel* const label : screen.findChildren<QLabel*>())
    for (const char* const known : {"Ready to calibrate", "missing", "Only the lens can be calibrated"})
      if (label->text().contains(known)) return label->text();
  return {};
}

}  // namespace

class TestCameraAlone : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  Scenario scenario_;
  QString raw_;

  // Opened as a recording, with the default board.
  void open(WindowFixture& test) {
    QSignalSpy opened(&test.window.files(), &SessionFiles::opened);
    test.window.files().open(raw_);
    QVERIFY(opened.wait(kPatience_ms));
    Session session = test.document().session();
    session.board = scenario_.board;
    test.document().edit(session, "The board");
    test.document().confirmBoard();
  }
  void chooseCamera(WindowFixture& test) {
    auto* const button = test.child<RecordingScreen>()->findChild<QPushButton*>("aim_camera");
    QVERIFY(button->isVisible());
    QTest::mouseClick(button, Qt::LeftButton);
  }

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    scenario_ = scenario();
    raw_ = scratch_.filePath("camera.raw");
    writeRaw(scenario_, raw_);
  }
  void init() { QSettings().clear(); }

  void story() {
    WindowFixture test;
    open(test);
    chooseCamera(test);
    QCOMPARE(test.screen(), QString("recording"));
    QVERIFY(test.child<RecordingScreen>()->findChild<QPushButton*>("aim_camera")->isChecked());
    QCOMPARE(verdictOf(*test.child<RecordingScreen>()), QString("Ready to calibrate"));

    int shown_live = 0;
    connect(&test.window.workbench().intrinsics, &IntrinsicsJob::detectionsChanged, &test.window,
            [&] { shown_live += test.child<DetectionScreen>()->isLive() ? 1 : 0; });
    test.press(Qt::Key_F5);
    QVERIFY2(test.runner().running(), qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(!test.child<RecordingScreen>()->findChild<QPushButton*>("aim_rig")->isEnabled());
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(shown_live > 0);
    QTRY_COMPARE(test.screen(), QString("result"));
    auto* const screen = test.child<LensScreen>();
    QVERIFY(screen->isVisible() && !test.child<ResultScreen>()->isVisible());
    QCOMPARE(test.child<QListWidget>("navigation")->findItems("Result: ok", Qt::MatchExactly).size(), 1);
    const auto run = test.window.workbench().lens.last().run;
    QVERIFY(run);
    const CameraIntrinsics& truth = scenario_.cameras.front().intrinsics;
    QVERIFY(projectionDifference(truth, run->result.intrinsics).rms_px < 0.15);
    QVERIFY(run->story.views.size() >= 10);
    QVERIFY(!run->story.tried.empty());
    auto* const numbers = screen->findChild<QTreeWidget*>("lens_numbers");
    QTRY_VERIFY(numbers->topLevelItemCount() >= 3);
    const double shown_px = numbers->topLevelItem(0)->child(0)->text(1).toDouble();
    QVERIFY(std::abs(shown_px - run->result.intrinsics.focal_length_px.x()) < 0.1);
    const QString first = test.child<StepsPanel>()->textOf("pass 1");
    QVERIFY2(first.contains("done") && first.contains("views"), qPrintable(first));
    QVERIFY(!test.child<DetectionScreen>()->timeline().windows().empty());

    saveAndReadBack(test);
    compareAndUse(test);
  }

  void rigOfOneCamera_isOfferedTheCameraAlone_andCancelsAtOnce() {
    WindowFixture test;
    open(test);
    auto* const recording = test.child<RecordingScreen>();
    QVERIFY(verdictOf(*recording).startsWith("Only the lens can be calibrated"));
    auto* const offer = recording->findChild<QPushButton*>("camera_only");
    QVERIFY(offer->isVisible());
    QSignalSpy stages(&test.runner(), &JobRunner::stageStarted);
    QTest::mouseClick(offer, Qt::LeftButton);
    QVERIFY(test.window.workbench().lens.aim() == CalibrationAim::Camera);
    while (stages.isEmpty() || stages.last().at(0).toString() != "pass 1") QVERIFY(stages.wait(kPatience_ms));
    spin(300);
    test.click("cancel");
    const ComputedTime since_cancel;
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY2(since_cancel.elapsed_ms() < maxAfterCancel_ms(),
             qPrintable(QString::number(since_cancel.elapsed_ms())));
    QVERIFY(test.child<StepsPanel>()->textOf("pass 1").contains("cancelled"));
    QVERIFY(!test.window.workbench().lens.last().run);
    test.document().undoStack().setClean();
  }

  void whatCannotBe_isSaidInTheWindowsWords_data() {
    QTest::addColumn<bool>("bright");
    QTest::addColumn<double>("end_s");
    QTest::addColumn<QStringList>("said");
    QTest::addRow("too few views") << false << 0.7
                                   << QStringList{"are needed for intrinsics", "Move the board"};
    QTest::addRow("another board") << true << 2.0
                                   << QStringList{"the board was never found", "rows, columns"};
  }
  void whatCannotBe_isSaidInTheWindowsWords() {
    QFETCH(bool, bright);
    QFETCH(double, end_s);
    QFETCH(QStringList, said);
    WindowFixture test;
    open(test);
    chooseCamera(test);
    Session session = test.document().session();
    if (bright) session.board.circles = CircleShade::Bright;
    session.time_range_s = {0.0, end_s};
    test.document().edit(session, "Spoil it");
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Failed);
    const QString text = test.child<ErrorPanel>()->text();
    for (const QString& part : said) QVERIFY2(text.contains(part), qPrintable(text));
    for (const char* const foreign : {"evical ", "rows, cols", "in the session", "_px", "_s:"})
      QVERIFY2(!text.contains(foreign), qPrintable(text));
    QVERIFY(!test.window.workbench().lens.last().run);
    test.document().undoStack().setClean();
  }

  void pagesOfRigs_sayThatTheyAre() {
    WindowFixture test;
    test.window.workbench().lens.setAim(CalibrationAim::Camera);
    for (const char* const page : {"trajectory", "convergence", "signals", "residuals"}) {
      QVERIFY(test.window.showScreen(page));
      const auto isSaid = [&] {
        for (const QLabel* const label : test.window.findChildren<QLabel*>())
          if (label->isVisible() && label->text().contains("to the calibration of a rig")) return true;
        return false;
      };
      QTRY_VERIFY2(isSaid(), page);
    }
    test.window.workbench().lens.setAim(CalibrationAim::Rig);
    test.window.showScreen("result");
    QTRY_VERIFY(test.child<ResultScreen>()->isVisible());
  }

  void aim_isARigAgain_ifALaterRecordingHasAnImu() {
    CalibrationDocument document;
    LensDocument lens(document);
    Session with_imu = readSession(simulatedTwoCameraSession().toStdString()), without = with_imu;
    QVERIFY(!with_imu.imus.empty());
    without.imus.clear();
    lens.setAim(CalibrationAim::Camera);
    document.startSession(with_imu);
    QVERIFY(lens.aim() == CalibrationAim::Camera);  // chosen before the first one
    document.startSession(without);
    QVERIFY(lens.aim() == CalibrationAim::Camera);
    document.startSession(with_imu);
    QVERIFY(lens.aim() == CalibrationAim::Rig);
  }

  void boardThatFlashes_isOfOneCameraAlone() {
    WindowFixture test;
    open(test);
    auto* const recording = test.child<RecordingScreen>();
    auto* const blinks = recording->findChild<QCheckBox*>("blinks");
    recording->findChild<QToolButton*>("board_more")->click();
    QVERIFY(blinks->isVisible());
    QTest::mouseClick(blinks, Qt::LeftButton, {}, {8, blinks->height() / 2});
    QVERIFY(test.document().session().board_blinks);
    chooseCamera(test);
    QCOMPARE(verdictOf(*recording), QString("Ready to calibrate"));
    const std::vector<SessionProblem> of_rig = sessionProblems(test.document().session());
    QVERIFY(std::any_of(of_rig.begin(), of_rig.end(),
                        [](const SessionProblem& problem) { return problem.field == "board"; }));
    test.document().undoStack().setClean();
  }

  void oneOfARig_isChosenByName() {
    WindowFixture test;
    test.window.files().open(simulatedTwoCameraSession());
    QTRY_VERIFY(test.document().hasSession());
    auto* const which = test.child<RecordingScreen>()->findChild<QComboBox*>("aim_which");
    QVERIFY(!which->isVisible());
    chooseCamera(test);
    QVERIFY(which->isVisible());
    QCOMPARE(which->count(), 2);
    which->setCurrentIndex(1);
    emit which->textActivated("right");
    QCOMPARE(test.window.workbench().lens.camera(), std::size_t{1});
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    const LensRecord& last = test.window.workbench().lens.last();
    QCOMPARE(last.camera, std::size_t{1});
    QVERIFY(last.seen->detections.cameras.at(0).windows.empty() &&
            !last.seen->detections.cameras.at(1).windows.empty());
    QCOMPARE(test.window.workbench().lens.others().size(), std::size_t{1});  // the session's own lens
  }

 private:
  void saveAndReadBack(WindowFixture& test) {
    const CameraIntrinsics& found = test.window.workbench().lens.last().run->result.intrinsics;
    for (const int file : {0, 1, 2}) {
      const QString path = scratch_.filePath(QString("mine_%1.yaml").arg(file));
      answerFileDialog(path);
      test.window.lensFiles().chooseFile(file);
      QCOMPARE(test.waitForJob(), JobOutcome::Done);
      const KnownIntrinsics read = readKnownIntrinsics(path.toStdString(), "", "");
      QVERIFY(read.camera.model == found.model);
      QVERIFY(projectionDifference(found, read.camera).rms_px < 1e-3);
      QCOMPARE(read.uncertainty.has_value(), file == 0);
    }
    const QString folder = scratch_.filePath("all");
    test.window.lensFiles().saveAllTo(folder);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (const LensFile& file : kLensFiles)
      QVERIFY2(QFileInfo(QDir(folder).filePath(file.name)).size() > 0, file.name);
    for (const char* const program :
         {"opencv", "metavision", "dv-processing", "ekalibr", "matlab", "numpy"}) {
      test.window.lensFiles().exportTo(program, scratch_.filePath("programs"));
      QVERIFY2(test.waitForJob() == JobOutcome::Done, program);
      QVERIFY2(!QDir(scratch_.filePath("programs/") + program).isEmpty(), program);
    }
  }

  void compareAndUse(WindowFixture& test) {
    auto* const screen = test.child<LensScreen>();
    answerFileDialog(scratch_.filePath("mine_2.yaml"));
    QTest::mouseClick(screen->findChild<QPushButton*>("lens_other"), Qt::LeftButton);
    QCOMPARE(screen->findChild<QComboBox*>("lens_against")->currentText(), QString("mine_2.yaml"));
    QVERIFY(!screen->findChild<QTreeWidget*>("lens_numbers")->isColumnHidden(4));
    QTest::mouseClick(screen->findChild<QPushButton*>("use_lens"), Qt::LeftButton);
    const SessionCamera& camera = test.document().session().cameras.front();
    QVERIFY(camera.intrinsics == test.window.workbench().lens.last().run->result.intrinsics);
    QVERIFY(!test.window.workbench().lens.runIsOutdated());
    QVERIFY(screen->findChild<QLabel*>("lens_in_session")->isVisibleTo(screen));
    QVERIFY(!screen->findChild<QPushButton*>("use_lens")->isEnabled());
    test.document().undoStack().undo();
    QVERIFY(!screen->findChild<QLabel*>("lens_in_session")->isVisibleTo(screen));
    QVERIFY(!test.document().session().cameras.front().intrinsics);
    test.document().undoStack().setClean();
  }
};

EVICAL_TEST(TestCameraAlone)

#include "tst_camera_alone.moc"
