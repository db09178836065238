// SPDX-License-Identifier: GPL-3.0-or-later
// The whole story, by mouse and keyboard: open, calibrate, cancel, calibrate again, change, export, reopen.
#include "ui/window/main_window.h"

#include "tests/ui/simulated_session.h"
#include "ui/forms/option_editor.h"
#include "ui/forms/option_form.h"
#include "ui/screens/result_screen.h"
#include "ui/screens/start_screen.h"
#include "ui/screens/stream_table.h"
#include "ui/theme/theme.h"
#include "ui/window/error_panel.h"
#include "ui/window/log_panel.h"
#include "ui/window/session_files.h"
#include "ui/window/steps_panel.h"

#include <QAbstractEventDispatcher>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QStackedWidget>
#include <QTemporaryDir>
#include <QTextBrowser>
#include <QToolButton>
#include <QTreeWidget>
#include <QtTest>

#include <ctime>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr int kPatience_ms = 120'000;

// Answers the next modal dialog: types a path into a file dialog, presses a button of a question.
void answerFileDialog(const QString& path) {
  QTimer::singleShot(200, qApp, [path] {
    auto* const dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
    if (dialog == nullptr) return answerFileDialog(path);
    auto* const edit = dialog->findChild<QLineEdit*>("fileNameEdit");
    edit->setText(path);
    QTest::keyClick(edit, Qt::Key_Return);
    if (dialog->isVisible())
      QMetaObject::invokeMethod(dialog, "accept");  // a completer may have taken the key
  });
}

void answerQuestion(QMessageBox::StandardButton button) {
  QTimer::singleShot(200, qApp, [button] {
    auto* const box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
    if (box == nullptr) return answerQuestion(button);
    QTest::mouseClick(box->button(button), Qt::LeftButton);
  });
}

struct Fixture {
  MainWindow window{"0.0.0"};
  QSignalSpy finished{&window.workbench().runner, &JobRunner::finished};

  Fixture() {
    window.show();
    QVERIFY(QTest::qWaitForWindowExposed(&window));
    window.activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(&window));
  }
  template <class Widget>
  Widget* child(const QString& name = {}) {
    return window.findChild<Widget*>(name);
  }
  CalibrationDocument& document() { return window.workbench().document; }
  JobRunner& runner() { return window.workbench().runner; }
  QString screen() {
    const auto* const stack = window.centralWidget()->findChild<QStackedWidget*>();
    return window.screenNames().value(stack->currentIndex());
  }
  void click(const QString& tool_button) {
    auto* const button = child<QToolButton>(tool_button);
    QVERIFY2(button && button->isVisible() && button->isEnabled(), qPrintable(tool_button));
    QTest::mouseClick(button, Qt::LeftButton);
  }
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    window.activateWindow();  // no window manager does it after a dialog
    QVERIFY(QTest::qWaitForWindowActive(&window));
    QTest::keyClick(&window, key, modifiers);
  }
  JobOutcome waitForJob() {
    if (finished.isEmpty()) finished.wait(kPatience_ms);
    return finished.isEmpty() ? JobOutcome::Failed : finished.takeLast().at(0).value<JobOutcome>();
  }
};

double threadTime_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// The longest that the GUI thread has worked without going back to its event loop; other load does not count.
class StallMeter : public QObject {
 public:
  StallMeter() {
    auto* const loop = QAbstractEventDispatcher::instance();
    connect(loop, &QAbstractEventDispatcher::awake, this, [this] { begin_ms_ = threadTime_ms(); });
    connect(loop, &QAbstractEventDispatcher::aboutToBlock, this, [this] {
      if (begin_ms_ > 0.0) longest_ms = std::max(longest_ms, threadTime_ms() - begin_ms_);
    });
  }
  double longest_ms = 0.0;

 private:
  double begin_ms_ = 0.0;
};

}  // namespace

class TestMainWindow : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() {
    QCoreApplication::setOrganizationName("evical_test");
    QStandardPaths::setTestModeEnabled(true);
    QDir(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)).removeRecursively();
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, scratch_.filePath("settings"));
    QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    applyTheme(*qApp, Appearance::Light);
    test::simulatedSession();
  }
  void init() { QSettings().clear(); }

  void story() {
    const QString session = test::copyOfSimulatedSession(scratch_.path());
    Fixture test;
    QCOMPARE(test.screen(), QString("start"));
    QVERIFY(!test.child<QToolButton>("calibrate")->isEnabled());

    answerFileDialog(session);
    test.press(Qt::Key_O, Qt::ControlModifier);
    QTRY_VERIFY(test.document().hasSession());
    QCOMPARE(test.screen(), QString("recording"));
    QTRY_COMPARE_WITH_TIMEOUT(test.child<StreamTable>()->rowCount(), 2, kPatience_ms);
    QVERIFY(!test.window.isWindowModified());

    QSignalSpy stages(&test.runner(), &JobRunner::stageStarted);
    test.click("calibrate");
    QVERIFY(stages.wait(kPatience_ms));
    test.click("cancel");
    QElapsedTimer since_cancel;
    since_cancel.start();
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY(since_cancel.elapsed() < 500);
    QVERIFY(!test.document().last().run);
    QVERIFY(test.child<StepsPanel>()->textOf("detect").contains("cancelled"));

    test.press(Qt::Key_F5);
    QVERIFY2(test.runner().running(), qPrintable(test.child<ErrorPanel>()->text()));
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(test.document().last().run);
    QCOMPARE(test.screen(), QString("result"));
    QVERIFY(test.child<StepsPanel>()->textOf("optimise").contains("done"));
    QVERIFY(test.child<StepsPanel>()->textOf("time offset").contains("correlation"));
    QVERIFY(test.child<LogPanel>()->shownText().contains("board in"));
    QVERIFY(test.child<ResultScreen>()->findChild<QTreeWidget*>()->topLevelItemCount() >= 3);

    changeAnOptionAndSave(test, session);
    exportTheResult(test);

    test.window.files().open(session);
    QCOMPARE(test.document().session().options.front_end.grid.least_circles, 9);
    QVERIFY(!test.document().last().run);
    QVERIFY(test.window.close());
  }

  void everyResult_isExportedWhereAskedTo() {
    const QString folder = scratch_.filePath("every");
    QVERIFY(QDir().mkpath(folder));
    Fixture test;
    test.window.files().open(test::copyOfSimulatedSession(scratch_.path()));
    answerFileDialog(folder);
    test.window.files().exportEveryResult(true);
    QSignalSpy exported(&test.window.files(), &SessionFiles::exported);
    test.window.calibrate();
    QTRY_COMPARE_WITH_TIMEOUT(exported.size(), 1, kPatience_ms);
    QVERIFY(QFileInfo(QDir(folder).filePath("result.yaml")).size() > 0);
    QVERIFY(test.window.close());
  }

  void demo_isSimulatedOnTheSpot_andCanBeCancelled() {
    Fixture test;
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
    file.write("this is no recording at all\n");
    file.close();
    Fixture test;
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
    Fixture test;
    Session session = readSession(test::simulatedSession().toStdString());
    session.cameras[0].intrinsics.reset();
    test.document().startSession(session);
    test.press(Qt::Key_F5);
    QVERIFY(!test.runner().running());
    QCOMPARE(test.screen(), QString("recording"));
    QVERIFY(test.child<ErrorPanel>()->text().contains("intrinsics"));
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  void failedCalibration_saysWhatToDo_andCanBeRepeated() {
    Fixture test;
    test.window.files().open(test::simulatedSession());
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
    Fixture test;
    test.window.files().open(test::simulatedSession());
    test.document().setOption("grid.least_circles", "9");
    QVERIFY(test.window.isWindowModified());
    answerQuestion(QMessageBox::Cancel);
    QVERIFY(!test.window.close());
    QVERIFY(test.window.isVisible());
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  void closeWhileRunning_cancelsAndThenCloses() {
    Fixture test;
    test.window.files().open(test::simulatedSession());
    test.press(Qt::Key_F5);
    QVERIFY(test.runner().running());
    QVERIFY(!test.window.close());
    QTRY_VERIFY_WITH_TIMEOUT(!test.window.isVisible(), kPatience_ms);
    QVERIFY(!test.runner().running());
  }

  void deletionWhileRunning_isClean() {
    auto test = std::make_unique<Fixture>();
    test->window.files().open(test::simulatedSession());
    test->press(Qt::Key_F5);
    QTest::qWait(100);
    test.reset();
    QCoreApplication::processEvents();
  }

  void droppedFile_isOpened() {
    Fixture test;
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(test::simulatedSession())});
    QDragEnterEvent enter(QPoint(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&test.window, &enter);
    QVERIFY(enter.isAccepted());
    QDropEvent drop(QPointF(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&test.window, &drop);
    QTRY_VERIFY(test.document().hasSession());
    QVERIFY(drop.isAccepted());
  }

  void layout_isRemembered() {
    {
      Fixture test;
      test.press(Qt::Key_L, Qt::ControlModifier);
      QVERIFY(test.window.findChild<QWidget*>("log")->isVisible());
      QVERIFY(test.window.close());
    }
    Fixture again;
    QVERIFY(again.window.findChild<QWidget*>("log")->isVisible());
  }

  void screens_areReachedByKeys() {
    Fixture test;
    const QStringList names = test.window.screenNames();
    for (qsizetype i = 0; i < names.size(); ++i) {
      test.press(static_cast<Qt::Key>(Qt::Key_1 + i), Qt::ControlModifier);
      QCOMPARE(test.screen(), names[i]);
    }
    test.press(Qt::Key_F1);
    auto* const guide = test.window.findChild<QDialog*>("user_guide");
    QVERIFY(guide->isVisible());
    QDir().mkpath(EVICAL_SCREENSHOTS);
    QVERIFY(guide->grab().save(EVICAL_SCREENSHOTS "/user_guide.png"));
    QVERIFY(guide->findChild<QTextBrowser*>()->toPlainText().contains("noise densities"));
  }

  void calibrating_neverStallsTheWindow() {
    Fixture test;
    test.window.files().open(test::simulatedSession());
    StallMeter meter;
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QTest::qWait(200);
    QVERIFY2(meter.longest_ms < 50.0, qPrintable(QString::number(meter.longest_ms)));
    QVERIFY(meter.longest_ms > 0.0);
  }

  void everyScreen_hasAPicture() {
    QDir().mkpath(EVICAL_SCREENSHOTS);
    for (const bool dark : {false, true}) {
      applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
      Fixture test;
      test.window.files().open(test::simulatedSession());
      test.press(Qt::Key_F5);
      QCOMPARE(test.waitForJob(), JobOutcome::Done);
      for (const QSize& size : {QSize(1280, 800), QSize(1920, 1080)}) {
        test.window.resize(size);
        for (const QString& name : test.window.screenNames()) {
          test.window.showScreen(name);
          QTest::qWait(100);
          const QImage picture = test.window.grab().toImage();
          QCOMPARE(picture.size(), size);
          QVERIFY(picture.save(QString("%1/%2_%3_%4.png")
                                   .arg(EVICAL_SCREENSHOTS, name)
                                   .arg(size.width())
                                   .arg(dark ? "dark" : "light")));
        }
      }
    }
    applyTheme(*qApp, Appearance::Light);
  }

 private:
  void changeAnOptionAndSave(Fixture& test, const QString& session) {
    test.press(Qt::Key_P, Qt::ControlModifier);
    auto* const form = test.child<OptionForm>();
    QVERIFY(form->isVisible());
    auto* const search = form->findChild<QLineEdit*>(QString(), Qt::FindDirectChildrenOnly);
    QTest::mouseClick(search, Qt::LeftButton);
    QTest::keyClicks(search, "least circles");
    auto* const field = form->editor("grid.least_circles")->findChild<QLineEdit*>();
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
    QCOMPARE(readSession(session.toStdString()).options.front_end.grid.least_circles, 9);
  }

  void exportTheResult(Fixture& test) {
    const QString folder = scratch_.filePath("exported");
    QVERIFY(QDir().mkpath(folder));
    answerFileDialog(folder);
    QTest::mouseClick(test.child<QPushButton>("export"), Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (const char* const file :
         {"result.yaml", "trajectory.csv", "detections.csv", "windows.csv", "log.txt"}) {
      QVERIFY2(QFileInfo(QDir(folder).filePath(file)).size() > 0, file);
    }
    const NamedResult read = readResultYaml(QDir(folder).filePath("result.yaml").toStdString());
    QCOMPARE(read.result.state.cameras.at(0).time_offset_s,
             test.document().last().run->result.state.cameras.at(0).time_offset_s);
  }
};

QTEST_MAIN(TestMainWindow)
#include "tst_main_window.moc"
