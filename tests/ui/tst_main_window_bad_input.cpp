// SPDX-License-Identifier: GPL-3.0-or-later
// External faults: full disks, recordings that disappear or are truncated during use, files of another type,
// a computer without OpenGL. The window keeps running and gives advice.
#include "ui/window/main_window.h"

#include "core/recording/conversion.h"
#include "tests/support/file_content.h"
#include "tests/support/test_program.h"
#include "tests/ui/full_disk.h"
#include "tests/ui/opengl.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/slowdown.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/event_view.h"
#include "ui/detection/timeline.h"
#include "ui/forms/repair_button.h"
#include "ui/scene/trajectory_screen.h"
#include "ui/scene/view3d.h"
#include "ui/screens/recording/stream_table.h"
#include "ui/window/error_panel.h"
#include "ui/window/recent_files.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"

#include <QFile>
#include <QProcess>
#include <QTemporaryDir>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

constexpr int kSoon_ms = 20'000 * kSlowdown;  // for work that takes hardly any time

void writeFile(const QString& path, const QByteArray& content) {
  QFile file(path);
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write(content);
}

}  // namespace

class TestMainWindowBadInput : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    simulatedSession();
  }
  void init() { QSettings().clear(); }

  void fullDisk_exportFailsWhole_andCanBeRepeatedElsewhere() {
    WindowFixture test;
    test.window.files().open(simulatedSession());
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    {
      const FullDisk disk;
      answerExportDialog({}, disk.path());
      test.press(Qt::Key_E, Qt::ControlModifier);
      QCOMPARE(test.waitForJob(), JobOutcome::Failed);
      auto* const panel = test.child<ErrorPanel>();
      QVERIFY(panel->isVisible());
      QVERIFY2(panel->text().contains("cannot be written"), qPrintable(panel->text()));
      QVERIFY2(panel->text().contains("What to do"), qPrintable(panel->text()));
      QVERIFY2(disk.files().isEmpty(), qPrintable(disk.files().join(' ')));
    }
    QVERIFY(test.document().last().run);
    const QString folder = scratch_.filePath("elsewhere");
    answerExportDialog({}, folder);
    test.press(Qt::Key_E, Qt::ControlModifier);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(QFile::exists(folder + "/result.yaml"));
    QVERIFY(!test.child<ErrorPanel>()->isVisible());
  }

  // A gyroscope with reversed axes: the panel offers the repair, a click applies it, and undo reverts
  // it.
  void failureWithARepair_isMendedByAClick() {
    WindowFixture test;
    Session session = readSession(simulatedSession().toStdString());
    session.imus[0].gyroscope_axes = {-1, -2, -3};
    test.document().startSession(session);
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Failed);
    auto* const button = test.child<ErrorPanel>()->findChild<RepairButton*>();
    QVERIFY2(test.child<ErrorPanel>()->text().contains("negated"),
             qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(button->isVisible());
    QCOMPARE(button->text(), QString("Set gyroscope_axes to x,y,z and calibrate again"));
    QTest::mouseClick(button, Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(test.document().session().imus[0].gyroscope_axes == kIdentityAxes);
    QVERIFY(test.document().last().run);
    QVERIFY(!test.child<ErrorPanel>()->isVisible());
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QVERIFY((test.document().session().imus[0].gyroscope_axes == AxesReading{-1, -2, -3}));
    QVERIFY(test.window.close());
  }

  void fullDisk_sessionStaysUnsaved() {
    WindowFixture test;
    const FullDisk disk;
    Session session = readSession(simulatedSession().toStdString());
    session.cameras.front().name = std::string(20'000, 'n');
    test.document().startSession(session);
    test.document().setOption("grid.min_circles", "9");
    answerFileDialog(disk.path() + "/session.yaml");
    QVERIFY(!test.window.files().saveAs());
    QVERIFY2(test.child<ErrorPanel>()->text().contains("not saved"),
             qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(test.window.isWindowModified());
    QVERIFY2(disk.files().isEmpty(), qPrintable(disk.files().join(' ')));
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  // Events in one file, IMU samples in another: the second adds the sensors that the session lacks. A file
  // without sensors changes nothing, and the streams stay listed.
  void recordingInTwoFiles_isPutTogether() {
    const QTemporaryDir folder;
    convertRecording({readSession(simulatedSession().toStdString()).recording,
                      folder.path().toStdString(),
                      "text",
                      {},
                      {}},
                     RunContext{});
    WindowFixture test;
    test.window.files().open(folder.filePath("events.txt"));
    QTRY_VERIFY_WITH_TIMEOUT(test.document().hasSession(), kPatience_ms);
    QVERIFY(test.document().session().imus.empty());
    const auto rows = [&] { return test.child<StreamTable>()->rowCount(); };
    test.window.files().addRecording(folder.filePath("imu.txt"));
    QTRY_COMPARE_WITH_TIMEOUT(test.document().session().imus.size(), std::size_t{1}, kPatience_ms);
    QTRY_COMPARE_WITH_TIMEOUT(rows(), 2, kPatience_ms);
    const SessionImu& imu = test.document().session().imus[0];
    QCOMPARE(QString::fromStdString(imu.recording.string()), folder.filePath("imu.txt"));
    QCOMPARE(test.document().session().reference, imu.name);
    QVERIFY(test.window.isWindowModified());
    test.window.files().addRecording(folder.filePath("imu.txt"));
    QVERIFY2(test.child<ErrorPanel>()->text().contains("listed already"),
             qPrintable(test.child<ErrorPanel>()->text()));
    const QString none = folder.filePath("none.bag");
    writeFile(none, "no recording");
    test.window.files().addRecording(none);
    QTRY_VERIFY_WITH_TIMEOUT(test.child<ErrorPanel>()->text().contains("none.bag"), kPatience_ms);
    QCOMPARE(rows(), 2);
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  // The open recording stays open, with its streams.
  void recordingThatIsNone_leavesTheOpenOneAlone() {
    const QTemporaryDir folder;
    WindowFixture test;
    test.window.files().open(simulatedSession());
    const auto rows = [&] { return test.child<StreamTable>()->rowCount(); };
    QTRY_COMPARE_WITH_TIMEOUT(rows(), 2, kPatience_ms);
    const QString none = folder.filePath("none.bag");
    writeFile(none, "no recording");
    test.window.files().open(none);
    QTRY_VERIFY_WITH_TIMEOUT(test.child<ErrorPanel>()->isVisible(), kPatience_ms);
    QTRY_COMPARE_WITH_TIMEOUT(rows(), 2, kPatience_ms);
    QVERIFY(!test.document().session().cameras.empty());
    QVERIFY(test.window.close());
  }

  // The dialog that opens files chooses folders, too.
  void folderWithoutRecording_isNamed() {
    const QTemporaryDir folder;
    QVERIFY(QDir(folder.path()).mkdir("pictures"));
    WindowFixture test;
    QTimer::singleShot(500, qApp, [&folder] {
      auto* const dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
      QVERIFY(dialog != nullptr);
      dialog->setDirectory(folder.filePath("pictures"));
      dialog->findChild<QPushButton*>("use_folder")->click();
    });
    test.press(Qt::Key_O, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(test.child<ErrorPanel>()->isVisible(), kPatience_ms);
    QVERIFY2(test.child<ErrorPanel>()->text().contains("pictures"),
             qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(test.window.close());
  }

  // Its events are in the program's cache; calibrating it again cannot work, and the message names the
  // missing file.
  void recordingRemoved_whilePlaying() {
    const QTemporaryDir folder;
    WindowFixture test;
    test.window.files().open(copyWithRecording(folder.path()));
    test.window.showScreen("detection");
    auto* const screen = test.child<DetectionScreen>();
    QTRY_VERIFY_WITH_TIMEOUT(screen->view().frame() != nullptr, kPatience_ms);
    screen->setPlaying(true);
    QVERIFY(QFile::remove(folder.filePath("recording.bag")));
    QTRY_VERIFY_WITH_TIMEOUT(screen->timeline().end_s() > 3.5, kPatience_ms);
    screen->setTime(3.0);
    QTRY_VERIFY_WITH_TIMEOUT(screen->view().frame() && screen->view().frame()->time_s >= 3.0, kPatience_ms);
    QVERIFY(screen->view().frame()->events > 0);
    screen->setPlaying(false);
    test.press(Qt::Key_F5);
    QVERIFY(!test.runner().running());
    QVERIFY2(test.child<ErrorPanel>()->text().contains("recording.bag"),
             qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(test.window.close());
  }

  void recordingRemoved_whileCalibrating() {
    const QTemporaryDir folder;
    WindowFixture test;
    test.window.files().open(copyWithRecording(folder.path()));
    calibrateUntilDetecting(test);
    QVERIFY(QFile::remove(folder.filePath("recording.bag")));
    QCOMPARE(test.waitForJob(), JobOutcome::Done);  // an open file continues to exist
    QVERIFY(test.document().last().run);
  }

  // The existing data can still be used; or nothing can, and the reason is given. Never more than that.
  void recordingCutOff_whileCalibrating() {
    const QTemporaryDir folder;
    WindowFixture test;
    const QString session = copyWithRecording(folder.path());
    const QString recording = folder.filePath("recording.bag");
    test.window.files().open(session);
    calibrateUntilDetecting(test);
    QVERIFY(QFile::resize(recording, QFileInfo(recording).size() / 2));
    const JobOutcome outcome = test.waitForJob();
    const QString log = test.runner().logText(), problem = test.child<ErrorPanel>()->text();
    qInfo("%s%s", outcome == JobOutcome::Done ? "done: " : "failed: ", qPrintable(problem));
    QVERIFY(outcome == JobOutcome::Done || outcome == JobOutcome::Failed);
    QVERIFY2(log.contains("  warning  "), qPrintable(log));
    QVERIFY2(outcome == JobOutcome::Done || problem.contains("What to do"), qPrintable(problem));
    test.window.showScreen("detection");
    spin(200);
    QVERIFY(test.window.close());
  }

  void recordingCutOff_whileItIsRead() {
    const QTemporaryDir folder;
    WindowFixture test;
    const QString session = copyWithRecording(folder.path());
    const QString recording = folder.filePath("recording.bag");
    test.window.showScreen("detection");
    test.window.files().open(session);
    QVERIFY(QFile::resize(recording, QFileInfo(recording).size() / 3));
    auto* const screen = test.child<DetectionScreen>();
    QTRY_VERIFY_WITH_TIMEOUT(screen->view().frame() != nullptr || !screen->view().message().isEmpty(),
                             kPatience_ms);
    screen->setPlaying(true);
    spin(300);
    screen->setPlaying(false);
    QVERIFY(test.window.close());
  }

  void sessionWithUnknownKey_namesItAndTheOneThatIsMeant() {
    WindowFixture test;
    test.window.files().open(simulatedSession());
    const QString good = test.document().file();
    const QString bad = scratch_.filePath("unknown.yaml");
    writeFile(bad, evical::test::fileContent(simulatedSession()) + "\nrecordings: a.bag\n");
    test.window.files().open(bad);
    auto* const panel = test.child<ErrorPanel>();
    QVERIFY(panel->isVisible());
    QVERIFY2(panel->text().contains("unknown.yaml"), qPrintable(panel->text()));
    QVERIFY2(panel->text().contains("recordings"), qPrintable(panel->text()));
    QVERIFY2(panel->text().contains("What to do"), qPrintable(panel->text()));
    QCOMPARE(test.document().file(), good);
    QVERIFY(!test.window.isWindowModified());
  }

  void sessionsThatAreNone_data() {
    QTest::addColumn<QByteArray>("content");
    QTest::newRow("empty") << QByteArray();
    QTest::newRow("a list") << QByteArray("- 1\n- 2\n");
    QTest::newRow("no YAML") << QByteArray("board: [1, 2\ncameras: {");
    QTest::newRow("wrong type") << QByteArray("recording: [a, b]\n");
    QTest::newRow("bytes") << QByteArray("\x00\xff\xfe\x01\x80 :", 7);
  }
  void sessionsThatAreNone() {
    QFETCH(QByteArray, content);
    const QString bad = scratch_.filePath("none.yaml");
    writeFile(bad, content);
    WindowFixture test;
    test.window.files().open(bad);
    QVERIFY(test.child<ErrorPanel>()->isVisible());
    QVERIFY(!test.document().hasSession());
    QVERIFY(recentFiles().isEmpty());
  }

  void filesThatAreNoRecording_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<QByteArray>("content");
    QTest::newRow("empty") << "empty.bag" << QByteArray();
    QTest::newRow("a picture") << "picture.png" << QByteArray("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    QTest::newRow("a bag's first line only") << "short.bag" << QByteArray("#ROSBAG V2.0\n");
    QTest::newRow("a bag with false contents")
        << "lie.bag" << QByteArray("#ROSBAG V2.0\n\xff\xff\xff\x7f\xff\xff\xff\x7f", 21);
    QTest::newRow("words") << "words.txt" << QByteArray("to be or not to be\nthat is the question\n");
    QTest::newRow("a folder of nothing") << "." << QByteArray();
    QTest::newRow("nothing at all") << "/nonexistent/recording.bag" << QByteArray();
  }
  void filesThatAreNoRecording() {
    QFETCH(QString, name);
    QFETCH(QByteArray, content);
    const QTemporaryDir folder;
    const bool inside = name != "." && !name.startsWith('/');
    const QString path = name == "." ? folder.path() : name.startsWith('/') ? name : folder.filePath(name);
    if (inside) writeFile(path, content);
    WindowFixture test;
    test.window.files().open(path);
    auto* const panel = test.child<ErrorPanel>();
    QTRY_VERIFY_WITH_TIMEOUT(panel->isVisible(), kSoon_ms);
    QVERIFY2(panel->text().contains(QFileInfo(path).fileName()), qPrintable(panel->text()));
    QVERIFY2(panel->text().contains("What to do"), qPrintable(panel->text()));
    QVERIFY(!test.document().hasSession());
    QVERIFY(recentFiles().isEmpty());
  }

  // The front end succeeds; then the IMU samples turn out to be from another time.
  void calibrationFailingHalfWay_keepsWhatWasThereBefore() {
    WindowFixture test;
    test.window.files().open(simulatedSession());
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    const auto before = test.document().last().run;
    Session other = test.document().session();
    other.imus.front().clock_offset_s = 1000.0;
    test.document().edit(other, "Change the clock");
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Failed);
    auto* const panel = test.child<ErrorPanel>();
    QVERIFY2(panel->isVisible() && panel->text().contains("What to do"), qPrintable(panel->text()));
    auto* const steps = test.child<StepsPanel>();
    QVERIFY2(steps->textOf("detect").contains("done"), qPrintable(steps->textOf("detect")));
    QVERIFY2(steps->textOf("initialise").contains("failed"), qPrintable(steps->textOf("initialise")));
    QCOMPARE(test.document().last().run, before);
    QVERIFY(!test.child<DetectionScreen>()->isLive());
    test.document().undoStack().undo();
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(!panel->isVisible());
    QVERIFY(test.window.close());
  }

  // In a separate process, since drivers are searched only once.
  void withoutOpenGl_everythingElseWorks() {
    if (qEnvironmentVariable(kEglVendors) != kNoEglVendor) {
      QProcess process;
      QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
      environment.insert(kEglVendors, kNoEglVendor);
      process.setProcessEnvironment(environment);
      process.start(QCoreApplication::applicationFilePath(),
                    {"tst_main_window_bad_input", "withoutOpenGl_everythingElseWorks"});
      QVERIFY(process.waitForFinished(kPatience_ms));
      QVERIFY2(process.exitStatus() == QProcess::NormalExit && process.exitCode() == 0,
               process.readAll().constData());
      return;
    }
    WindowFixture test;
    test.window.files().open(simulatedSession());
    test.window.showScreen("trajectory");
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    spin(300);
    const View3D* const view = test.child<TrajectoryScreen>()->view();
    QVERIFY(!view->problem().isEmpty());
    QCOMPARE(test.screen(), QString("trajectory"));
    const QImage picture = test.window.grab().toImage();
    QCOMPARE(picture.size(), test.window.size());
    QVERIFY(test.document().last().run);
    QVERIFY(test.window.close());
  }

 private:
  static void calibrateUntilDetecting(WindowFixture& test) {
    double fraction = 0.0;
    const auto watch = QObject::connect(&test.runner(), &JobRunner::progressed, &test.window,
                                        [&](const JobProgress& progress) { fraction = progress.fraction; });
    test.press(Qt::Key_F5);
    QTRY_VERIFY_WITH_TIMEOUT(fraction > 0.0, kPatience_ms);
    QObject::disconnect(watch);
    QVERIFY(test.runner().running());
  }
};

EVICAL_TEST(TestMainWindowBadInput)
#include "tst_main_window_bad_input.moc"
