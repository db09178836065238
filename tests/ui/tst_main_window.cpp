// SPDX-License-Identifier: GPL-3.0-or-later
// The complete workflow, by mouse and keyboard: open, calibrate, cancel, calibrate again, change, export,
// reopen.
#include "core/frontend/detection_options.h"
#include "ui/window/main_window.h"

#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/screenshots.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/slowdown.h"
#include "tests/ui/stall_meter.h"
#include "tests/ui/window_fixture.h"
#include "ui/forms/option_editor.h"
#include "ui/forms/option_form.h"
#include "ui/plots/residuals_screen.h"
#include "ui/screens/recording/start_screen.h"
#include "ui/screens/recording/stream_table.h"
#include "ui/screens/result/result_screen.h"
#include "ui/window/error_panel.h"
#include "ui/window/log_panel.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"

#include <QDesktopServices>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMimeData>
#include <QPushButton>
#include <QScopeGuard>
#include <QSettings>
#include <QSignalSpy>
#include <QStatusBar>
#include <QTemporaryDir>
#include <QTextBrowser>
#include <QToolButton>
#include <QTreeWidget>

#include <sys/stat.h>

#include <algorithm>
#include <limits>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

QAction* actionOf(const MainWindow& window, const QString& text) {
  for (QAction* const action : window.findChildren<QAction*>())
    if (action->text() == text) return action;
  return nullptr;
}

// Labels and buttons that are not hidden, even if their page is not in front.
QString visibleTexts(const QWidget& page) {
  QString all;
  for (const QLabel* const label : page.findChildren<QLabel*>())
    if (!label->isHidden()) all += label->text() + '\n';
  return all;
}

class ReportReader : public QObject {
  Q_OBJECT

 public:
  QString file;

 public slots:
  void open(const QUrl& url) { file = url.toLocalFile(); }
};

}  // namespace

class TestMainWindow : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    simulatedSession();
  }
  void init() { QSettings().clear(); }

  void story() {
    const QString session = copyOfSimulatedSession(scratch_.path());
    WindowFixture test;
    QCOMPARE(test.screen(), QString("start"));
    QVERIFY(!test.child<QToolButton>("calibrate")->isEnabled());
    const QAction* const report = actionOf(test.window, "Open re&port");
    QVERIFY(!report->isEnabled() && report->toolTip().contains("no result yet"));

    answerFileDialog(session);
    test.press(Qt::Key_O, Qt::ControlModifier);
    QTRY_VERIFY(test.document().hasSession());
    QCOMPARE(test.screen(), QString("recording"));
    QTRY_COMPARE_WITH_TIMEOUT(test.child<StreamTable>()->rowCount(), 2, kPatience_ms);
    QVERIFY(!test.window.isWindowModified());

    QSignalSpy stages(&test.runner(), &JobRunner::stageStarted);
    test.click("calibrate");
    QVERIFY(stages.wait(kPatience_ms));
    QVERIFY(visibleTexts(*test.child<ResultScreen>()).contains("Calibrating: the result is shown here"));
    QVERIFY(visibleTexts(*test.child<ResidualsScreen>()).contains("Calibrating: this page"));
    test.click("cancel");
    QElapsedTimer since_cancel;
    since_cancel.start();
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY(since_cancel.elapsed() < 500 * kSlowdown);
    QVERIFY(!test.document().last().run);
    QVERIFY(test.child<StepsPanel>()->textOf("detect").contains("cancelled"));
    QVERIFY(test.child<LogPanel>()->shownText().contains("Calibrate: cancelled"));
    QVERIFY(visibleTexts(*test.child<ResultScreen>()).contains("No calibration yet: press Calibrate"));
    auto* const pages = test.child<QListWidget>("navigation");
    QVERIFY(pages->findItems("Result: ", Qt::MatchStartsWith).isEmpty());

    test.press(Qt::Key_F5);
    QVERIFY2(test.runner().running(), qPrintable(test.child<ErrorPanel>()->text()));
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(test.document().last().run);
    QTRY_COMPARE(test.screen(), QString("result"));
    const QString verdict = statusName(test.document().last().run->result.status);
    QCOMPARE(pages->findItems("Result: " + verdict, Qt::MatchExactly).size(), 1);
    QVERIFY(test.child<StepsPanel>()->textOf("optimise").contains("done"));
    QVERIFY(test.child<StepsPanel>()->textOf("time offset").contains("correlation"));
    QVERIFY(test.child<LogPanel>()->shownText().contains("board in"));
    QVERIFY(test.child<ResultScreen>()->findChild<QTreeWidget*>()->topLevelItemCount() >= 3);

    changeAnOptionAndSave(test, session);
    exportTheResult(test);
    openTheReport(test);

    test.window.files().open(session);
    QCOMPARE(test.document().session().options.front_end->grid.min_circles, 9);
    QVERIFY(!test.document().last().run);
    QVERIFY(test.window.close());
  }

  void everyResult_isExportedWhereAskedTo() {
    const QString folder = scratch_.filePath("every");
    QVERIFY(QDir().mkpath(folder));
    WindowFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    answerFileDialog(folder);
    test.window.files().exportEveryResult(true);
    QSignalSpy exported(&test.window.files(), &SessionFiles::exported);
    test.window.calibrate();
    QTRY_COMPARE_WITH_TIMEOUT(exported.size(), 1, kPatience_ms);
    QVERIFY(QFileInfo(QDir(folder).filePath("result.yaml")).size() > 0);
    QVERIFY(test.window.close());
  }

  void pagesWithoutContent_areGrey_withTheReason() {
    WindowFixture test;
    auto* const list = test.child<QListWidget>("navigation");
    const auto enabled = [list](const QString& title) {
      const QListWidgetItem* const item = list->findItems(title, Qt::MatchStartsWith).front();
      return bool(item->flags() & Qt::ItemIsEnabled);
    };
    const auto shown = [list](const QString& text) {
      const auto items = list->findItems(text, Qt::MatchStartsWith);
      return !items.isEmpty() && !items.front()->isHidden();
    };
    QVERIFY(enabled("Start") && !enabled("Recording") && !enabled("Result"));
    QVERIFY(shown("Open a recording first") && !shown("Check a result"));
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QVERIFY(enabled("Recording") && enabled("Detection") && !enabled("Trajectory") && !enabled("Result"));
    QVERIFY(shown("Press Calibrate"));
    QCOMPARE(list->findItems("Result", Qt::MatchExactly).front()->toolTip(),
             QString("Press Calibrate to fill grey pages"));
    const QListWidgetItem* const more = list->findItems("More", Qt::MatchExactly).front();
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualItemRect(more).center());
    QVERIFY(shown("Check a result") && enabled("Check a result"));
    test.window.calibrate();
    QVERIFY(enabled("Trajectory"));  // filled live
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(enabled("Trajectory") && enabled("Result") && !shown("Press Calibrate"));
    test.window.workbench().lens.setAim(CalibrationAim::Camera);
    QVERIFY(!enabled("Trajectory") && shown("Grey pages are for rigs only"));
  }

  void recentFiles_haveNameDateAndVerdict() {
    WindowFixture test;
    auto* const recent = test.child<QTreeWidget>("recent");
    QVERIFY(!recent->isVisible());
    const QString session = copyOfSimulatedSession(scratch_.path());
    test.window.files().open(session);
    QCOMPARE(recent->topLevelItemCount(), 1);
    QCOMPARE(recent->topLevelItem(0)->text(0), QFileInfo(session).dir().dirName());
    QCOMPARE(recent->topLevelItem(0)->text(2), QString("not calibrated"));
    test.window.calibrate();
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QCOMPARE(recent->topLevelItem(0)->text(2),
             QString(statusName(test.document().last().run->result.status)));
    QVERIFY(recent->topLevelItem(0)->toolTip(0).contains(session));
    WindowFixture later;
    QCOMPARE(later.child<QTreeWidget>("recent")->topLevelItem(0)->text(2), recent->topLevelItem(0)->text(2));
  }

  // Settings may be changed by hand.
  void recentFiles_ofAnImpossibleNumber_doNotStopTheWindow() {
    {
      QSettings settings;
      settings.setValue("recent/size", 2147483647);
      settings.setValue("recent/1/path", scratch_.path());
    }
    QElapsedTimer opening;
    opening.start();
    const WindowFixture test;
    QVERIFY2(opening.elapsed() < 8000 * kSlowdown, "the window did not open");
  }

  void demo_isSimulatedOnTheSpot_andCanBeCancelled() {
    WindowFixture test;
    double fraction = 0.0;
    connect(&test.runner(), &JobRunner::progressed, &test.window,
            [&](const JobProgress& progress) { fraction = progress.fraction; });
    for (QPushButton* const button : test.child<StartScreen>()->findChildren<QPushButton*>())
      if (button->text().contains("demo")) QTest::mouseClick(button, Qt::LeftButton);
    QVERIFY(test.runner().running());
    QTRY_VERIFY_WITH_TIMEOUT(fraction > 0.0, kPatience_ms);
    test.click("cancel");
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY(!test.document().hasSession());
    QVERIFY(!test.child<ErrorPanel>()->isVisible());
  }

  void problemOfTheRecording_isShownInThePanel() {
    const QString fake = scratch_.filePath("fake.bag");
    QFile file(fake);
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write("this is not a recording\n");
    file.close();
    WindowFixture test;
    test.window.files().open(fake);
    auto* const panel = test.child<ErrorPanel>();
    QTRY_VERIFY(panel->isVisible());
    QVERIFY(panel->text().contains("fake.bag"));
    QVERIFY(panel->text().contains("What to do"));
    QVERIFY(!test.document().hasSession());
    panel->setFocus();
    QTest::keyClick(panel, Qt::Key_Escape);
    QVERIFY(!panel->isVisible());
  }

  void incompleteSession_isNotStarted_andTheFieldIsNamed() {
    WindowFixture test;
    Session session = readSession(simulatedSession().toStdString());
    session.cameras[0].intrinsics->focal_length_px.x() = 0.0;
    test.document().startSession(session);
    test.press(Qt::Key_F5);
    QVERIFY(!test.runner().running());
    QCOMPARE(test.screen(), QString("recording"));
    const QString problem = test.child<ErrorPanel>()->text();
    QVERIFY2(problem.contains("ocal_length_px"), qPrintable(problem));
    QVERIFY(test.window.close());
  }

  void unknownIntrinsics_areCalibratedFirst_andShownWithTheResult() {
    WindowFixture test;
    Session session = readSession(simulatedSession().toStdString());
    const double truth_px = session.cameras[0].intrinsics->focal_length_px.x();
    session.cameras[0].intrinsics.reset();
    test.document().startSession(session);
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    const StepsPanel* const steps = test.child<StepsPanel>();
    QVERIFY2(steps->textOf("intrinsics").contains("done"), qPrintable(steps->textOf("intrinsics")));
    const RunRecord& last = test.document().last();
    const auto lens = [&] { return last.run->result.state.cameras[0].lens; };
    QVERIFY(std::abs(lens().detection_intrinsics->focal_length_px.x() - truth_px) < 0.005 * truth_px);
    QVERIFY(!test.document().runIsOutdated());
    test.window.showScreen("result");
    spin(200);  // filled in a later turn of the event loop
    QStringList rows;
    for (const QTreeWidget* const tree : test.child<ResultScreen>()->findChildren<QTreeWidget*>())
      for (QTreeWidgetItem* const row :
           tree->findItems("Focal length", Qt::MatchStartsWith | Qt::MatchRecursive))
        rows << row->text(0) + ' ' + row->text(1) + ' ' + row->text(2);
    QCOMPARE(rows.size(), 2);
    QVERIFY2(rows[0].split(' ').last().toDouble() > 0.0, qPrintable(rows.join('\n')));
    emit test.child<ResidualsScreen>()->recalibrateWithout({0});
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(!test.document().runIsOutdated());
    test.window.showScreen("recording");
    auto* const take_over = test.child<QPushButton>("take_over");
    QVERIFY(take_over->isVisible());
    QTest::mouseClick(take_over, Qt::LeftButton);
    const auto& taken = test.document().session().cameras[0].intrinsics;
    QVERIFY(taken && taken == lens().solved);  // with everything else
    QVERIFY(std::abs(taken->focal_length_px.x() - truth_px) < 0.005 * truth_px);
    QVERIFY(!take_over->isVisible());
    test.document().undoStack().undo();
    QVERIFY(!test.document().session().cameras[0].intrinsics);
    QVERIFY(test.document().rejectedCount() == 1);  // closing would ask
    while (test.document().undoStack().canUndo()) test.document().undoStack().undo();
    QVERIFY(test.window.close());
  }

  void failedCalibration_saysWhatToDo_andCanBeRepeated() {
    WindowFixture test;
    test.window.files().open(simulatedSession());
    Session other = test.document().session();
    other.time_range_s = {{0.0, 1.0}};
    test.document().edit(other, "Shorten");
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Failed);
    QVERIFY(test.child<ErrorPanel>()->text().contains("too short"));
    QTRY_VERIFY(test.child<QToolButton>("calibrate")->isVisible());
    test.document().undoStack().undo();
    QVERIFY(test.window.close());
  }

  void unsavedChanges_areAskedAbout() {
    WindowFixture test;
    test.window.files().open(simulatedSession());
    test.document().setOption("grid.min_circles", "9");
    QVERIFY(test.window.isWindowModified());
    answerQuestion(QMessageBox::Cancel);
    QVERIFY(!test.window.close());
    QVERIFY(test.window.isVisible());
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  // A question would read as if the recording were to be written, and nothing can be lost.
  void recordingThatNobodyTouched_isLeftWithoutAQuestion() {
    WindowFixture test;
    QSignalSpy opened(&test.window.files(), &SessionFiles::opened);
    const Session session = readSession(simulatedSession().toStdString());
    test.window.files().open(QString::fromStdString(session.recording.string()));
    QVERIFY(opened.wait(kPatience_ms));
    QVERIFY(test.document().file().isEmpty());
    QVERIFY(!test.window.isWindowModified());
    auto* const save = test.child<QAction>("save");
    QVERIFY(save->isEnabled());  // it may nevertheless be saved as a session
    QVERIFY(test.window.close());
  }

  void closeWhileRunning_asks_thenCancelsAndCloses() {
    WindowFixture test;
    test.window.files().open(simulatedSession());
    test.press(Qt::Key_F5);
    QVERIFY(test.runner().running());
    answerQuestion(QMessageBox::No);
    QVERIFY(!test.window.close());
    QVERIFY(test.window.isVisible() && !test.runner().cancelling());
    answerQuestion(QMessageBox::Yes);
    QVERIFY(!test.window.close());
    QTRY_VERIFY_WITH_TIMEOUT(!test.window.isVisible(), kPatience_ms);
    QVERIFY(!test.runner().running());
  }

  void deletionWhileRunning_isClean() {
    auto test = std::make_unique<WindowFixture>();
    test->window.files().open(simulatedSession());
    test->press(Qt::Key_F5);
    QTest::qWait(100);
    test.reset();
    QCoreApplication::processEvents();
  }

  void droppedFile_isOpened() {
    WindowFixture test;
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(simulatedSession())});
    QDragEnterEvent enter(QPoint(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&test.window, &enter);
    QVERIFY(enter.isAccepted());
    QDropEvent drop(QPointF(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&test.window, &drop);
    QTRY_VERIFY(test.document().hasSession());
    QVERIFY(drop.isAccepted());
  }

  // Nothing that cannot be a recording stops the window, or is opened.
  void droppedThings_thatAreNoFiles_areRefused_data() {
    QTest::addColumn<QStringList>("urls");
    QTest::addColumn<bool>("accepted");
    QTest::newRow("nothing") << QStringList() << false;
    QTest::newRow("a page") << QStringList("https://example.org/recording.bag") << false;
    QTest::newRow("two files") << QStringList{"file:///dev/null", "file:///dev/zero"} << false;
    QTest::newRow("a pipe") << QStringList("file://" + scratch_.filePath("pipe.yaml")) << true;
    QTest::newRow("a pipe as a recording") << QStringList("file://" + scratch_.filePath("pipe")) << true;
    QTest::newRow("a device") << QStringList("file:///dev/zero") << true;
    QTest::newRow("a folder") << QStringList("file:///proc/self/fd") << true;
    QTest::newRow("markup") << QStringList("file:///<img src=\"/dev/zero\">") << true;
    QTest::newRow("another computer") << QStringList("file://computer/share/recording.bag") << true;
  }
  void droppedThings_thatAreNoFiles_areRefused() {
    QFETCH(const QStringList, urls);
    QFETCH(const bool, accepted);
    for (const char* const pipe : {"pipe", "pipe.yaml"}) ::mkfifo(qPrintable(scratch_.filePath(pipe)), 0600);
    WindowFixture test;
    QMimeData data;
    data.setText(QString(1'000'000, 'x'));
    QList<QUrl> dropped;
    for (const QString& url : urls) dropped << QUrl(url);
    data.setUrls(dropped);
    QDragEnterEvent enter(QPoint(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    enter.ignore();
    QCoreApplication::sendEvent(&test.window, &enter);
    QCOMPARE(enter.isAccepted(), accepted);
    QDropEvent drop(QPointF(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&test.window, &drop);
    QElapsedTimer answered;
    answered.start();
    spin(1000);
    QVERIFY2(answered.elapsed() < 5000 * kSlowdown, "the window did not answer");
    QVERIFY(!test.document().hasSession());
  }

  // Pages keep their place when a run starts: a second click must not reach the next page.
  void sideBar_staysInPlace_whenARunStarts() {
    WindowFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    auto* const list = test.child<QListWidget>("navigation");
    const auto places = [list] {
      std::vector<QRect> all;
      for (const char* const title : {"Start", "Recording", "Detection", "Residuals", "More"})
        all.push_back(list->visualItemRect(
            list->findItems(title, Qt::MatchStartsWith | Qt::MatchCaseSensitive).front()));
      return all;
    };
    const auto line = [list] { return list->item(2)->text(); };  // below the heading: never blank
    const std::vector<QRect> before = places();
    QCOMPARE(line(), QString("Press Calibrate to fill grey pages"));
    const QRect steps = test.child<StepsPanel>()->geometry();
    test.window.calibrate();
    spin(50);
    QVERIFY(test.runner().running());
    QCOMPARE(line(), QString("recording.bag"));
    QVERIFY(places() == before);
    QCOMPARE(test.child<StepsPanel>()->geometry(), steps);
    test.click("cancel");
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY(places() == before);
    QVERIFY(test.window.close());
  }

  // 1280x800 with the title bar and a panel of the desktop: nothing may enlarge the window beyond it.
  void docks_andErrors_fitASmallDisplay() {
    constexpr int kFree_px = 740;
    WindowFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    test.window.resize(1280, kFree_px);
    for (const char* const name : {"log", "runs"}) {
      auto* const dock = test.child<QDockWidget>(name);
      dock->show();
      dock->raise();
      spin(50);
      QVERIFY2(test.window.height() == kFree_px,
               qPrintable(QString("%1: %2 px").arg(name).arg(test.window.height())));
      const QRect status = test.window.statusBar()->geometry();
      QVERIFY(test.window.rect().contains(status) && status.height() > 10);
    }
    test.child<ErrorPanel>()->showError("Calibrate failed",
                                        {true, "left", "the board was never found", "Check the board"});
    spin(50);
    QCOMPARE(test.window.height(), kFree_px);
    QVERIFY(test.window.close());
  }

  // A large recording takes seconds to read: meanwhile the old session is not shown under the new name.
  void anotherRecording_replacesTheViewAtOnce() {
    WindowFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    test.window.showScreen("detection");
    const QString recording = QString::fromStdString(test.document().session().recording.string());
    spin(200);
    test.window.files().open(recording);
    QCOMPARE(test.screen(), QString("recording"));
    const auto* const reading = test.child<QLabel>("reading");
    QVERIFY2(reading->isVisible() && reading->text().contains("recording.bag"), qPrintable(reading->text()));
    QVERIFY(test.window.windowTitle().startsWith("recording.bag"));
    QVERIFY(visibleTexts(*test.window.statusBar()).contains("Reading recording.bag"));
    QVERIFY(!test.child<QToolButton>("calibrate")->isEnabled());
    QTRY_VERIFY_WITH_TIMEOUT(!reading->isVisible() && test.document().file().isEmpty(), kPatience_ms);
    QVERIFY(test.child<QToolButton>("calibrate")->isEnabled());
    QVERIFY(!visibleTexts(*test.window.statusBar()).contains("Reading"));
    // A file that is not a recording leaves the session.
    const QString nothing = scratch_.filePath("nothing.bag");
    QFile file(nothing);
    QVERIFY(file.open(QIODevice::WriteOnly) && file.write("nothing") > 0);
    file.close();
    test.window.files().open(nothing);
    QTRY_VERIFY_WITH_TIMEOUT(test.child<ErrorPanel>()->isVisible(), kPatience_ms);
    QVERIFY(!reading->isVisible());
    QCOMPARE(QString::fromStdString(test.document().session().recording.string()), recording);
    QVERIFY(test.window.close());
  }

  // A title bar needs space, too.
  void firstStart_fitsTheScreen() {
    WindowFixture test;
    QVERIFY(test.window.height() < test.window.screen()->availableGeometry().height() - 30);
  }

  void layout_isRemembered() {
    {
      WindowFixture test;
      test.press(Qt::Key_L, Qt::ControlModifier);
      QVERIFY(test.window.findChild<QWidget*>("log")->isVisible());
      QVERIFY(test.window.close());
    }
    WindowFixture again;
    QVERIFY(again.window.findChild<QWidget*>("log")->isVisible());
  }

  void screens_areReachedByKeys() {
    WindowFixture test;
    const QStringList names = test.window.screenNames();
    test.press(Qt::Key_2, Qt::ControlModifier);
    QCOMPARE(test.screen(), QString("start"));  // Recording is grey: it has no content yet
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    test.window.calibrate();
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (qsizetype i = 0; i < names.size(); ++i) {
      test.press(static_cast<Qt::Key>(Qt::Key_0 + (i + 1) % 10),
                 i < 10 ? Qt::ControlModifier : Qt::ControlModifier | Qt::ShiftModifier);
      QCOMPARE(test.screen(), names[i]);
    }
    test.press(Qt::Key_F1);
    auto* const guide = test.window.findChild<QDialog*>("user_guide");
    QVERIFY(guide->isVisible());
    QVERIFY(guide->grab().save(screenshotPath("user_guide.png")));
    QVERIFY(guide->findChild<QTextBrowser*>()->toPlainText().contains("noise densities"));
  }

  // The minimum of up to three runs: other load on the machine or its host can only increase the time.
  void calibrating_neverStallsTheWindow() {
    double min_ms = std::numeric_limits<double>::max();
    for (int run = 0; run < 3 && min_ms >= 50.0 * slowness(); ++run) {
      WindowFixture test;
      test.window.files().open(simulatedSession());
      StallMeter meter;
      const OtherLoad others;
      test.press(Qt::Key_F5);
      QCOMPARE(test.waitForJob(), JobOutcome::Done);
      QTest::qWait(200);
      const double longest_ms = others.quiet() ? meter.longest_ms() : meter.longestWork_ms();
      qInfo("%.1f ms, others keep %.1f processors busy", longest_ms, others.processors());
      QVERIFY(meter.beats() > 10);
      min_ms = std::min(min_ms, longest_ms);
    }
    QVERIFY(min_ms < 50.0 * slowness());
  }

  void everyScreen_hasAPicture() {
    for (const bool dark : {false, true}) {
      applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
      WindowFixture test;
      test.window.files().open(simulatedSession());
      test.press(Qt::Key_F5);
      QCOMPARE(test.waitForJob(), JobOutcome::Done);
      for (const QSize& size : {QSize(1280, 800), QSize(1920, 1080)}) {
        test.window.resize(size);
        for (const QString& name : test.window.screenNames()) {
          test.window.showScreen(name);
          QTest::qWait(100);
          const QImage picture = test.window.grab().toImage();
          QCOMPARE(picture.size(), size);
          QVERIFY(picture.save(
              screenshotPath("%1_%2_%3.png").arg(name).arg(size.width()).arg(dark ? "dark" : "light")));
        }
      }
    }
    applyTheme(*qApp, Appearance::Light);
  }

 private:
  void changeAnOptionAndSave(WindowFixture& test, const QString& session) {
    test.press(Qt::Key_P, Qt::ControlModifier);
    auto* const form = test.child<OptionForm>();
    QVERIFY(form->isVisible());
    auto* const search = form->findChild<QLineEdit*>(QString(), Qt::FindDirectChildrenOnly);
    QTest::mouseClick(search, Qt::LeftButton);
    QTest::keyClicks(search, "min circles");
    auto* const field = form->editor("grid.min_circles")->findChild<QLineEdit*>();
    QVERIFY(field->isVisible());
    field->selectAll();
    QTest::keyClicks(field, "9");
    QTest::keyClick(field, Qt::Key_Return);
    QVERIFY(test.window.isWindowModified());
    QVERIFY(test.document().runIsOutdated());
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(!test.window.isWindowModified());
    test.press(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    QVERIFY(test.window.isWindowModified());
    test.press(Qt::Key_S, Qt::ControlModifier);
    QVERIFY(!test.window.isWindowModified());
    QCOMPARE(readSession(session.toStdString()).options.front_end->grid.min_circles, 9);
  }

  void exportTheResult(WindowFixture& test) {
    const QString folder = scratch_.filePath("exported");
    answerExportDialog({"openvins", "esvo"}, folder);
    QTest::mouseClick(test.child<QPushButton>("export"), Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (const char* const file :
         {"result.yaml", "trajectory.csv", "detections.csv", "detections.yaml", "windows.csv", "log.txt",
          "kalibr/camchain-imucam.yaml", "openvins/kalibr_imu_chain.yaml"}) {
      QVERIFY2(QFileInfo(QDir(folder).filePath(file)).size() > 0, file);
    }
    const NamedResult read = readResultYaml(QDir(folder).filePath("result.yaml").toStdString());
    QCOMPARE(read.result->state.cameras.at(0).time_offset_s,
             test.document().last().run->result.state.cameras.at(0).time_offset_s);
    QVERIFY(test.child<LogPanel>()->shownText().contains("random walks are not measured"));
    auto* const notice = test.child<ExportNotice>();
    QVERIFY(notice->isVisible());
    QVERIFY2(notice->text().contains("esvo: not exported: result: has one camera") &&
                 notice->text().contains("Kalibr, OpenVINS") && notice->text().contains(folder),
             qPrintable(notice->text()));
    ReportReader reader;
    QDesktopServices::setUrlHandler("file", &reader, "open");
    const auto restored = qScopeGuard([] { QDesktopServices::unsetUrlHandler("file"); });
    QTest::mouseClick(test.child<QPushButton>("open_folder"), Qt::LeftButton);
    QCOMPARE(reader.file, QFileInfo(folder).absoluteFilePath());
  }

  // The test takes the browser's role for a moment.
  void openTheReport(WindowFixture& test) {
    ReportReader reader;
    QDesktopServices::setUrlHandler("file", &reader, "open");
    const auto restored = qScopeGuard([] { QDesktopServices::unsetUrlHandler("file"); });
    QTest::mouseClick(test.child<QPushButton>("report"), Qt::LeftButton);
    QCOMPARE(reader.file, QFileInfo(scratch_.filePath("exported/report.html")).absoluteFilePath());
    QVERIFY(QFile::remove(reader.file));
    reader.file.clear();
    test.finished.clear();
    test.press(Qt::Key_R, Qt::ControlModifier);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY2(QFileInfo(reader.file).size() > 10000, qPrintable(reader.file));
  }
};

EVICAL_TEST(TestMainWindow)
#include "tst_main_window.moc"
