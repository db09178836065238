// SPDX-License-Identifier: GPL-3.0-or-later
// Kept runs: undone, kept, opened again, compared; with a missing recording, and from a damaged folder.
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/runs/saved_run.h"
#include "tests/support/test_program.h"
#include "tests/ui/screenshots.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/timeline.h"
#include "ui/jobs/run_history.h"
#include "ui/plots/plot_panel.h"
#include "ui/plots/residuals_screen.h"
#include "ui/screens/result/result_screen.h"
#include "ui/screens/result/runs_panel.h"
#include "ui/window/error_panel.h"
#include "ui/window/session_files.h"

#include <QComboBox>
#include <QDropEvent>
#include <QMimeData>
#include <QPushButton>
#include <QTreeWidget>

#include <filesystem>
#include <functional>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

// Text of the Result page: all of its quantities.
QStringList shownNumbers(WindowFixture& test) {
  QStringList texts;
  const QTreeWidget* const tree = test.child<ResultScreen>()->findChild<QTreeWidget*>();
  for (int group = 0; group < tree->topLevelItemCount(); ++group)
    for (int row = 0; row < tree->topLevelItem(group)->childCount(); ++row)
      for (int column = 0; column < 4; ++column) texts << tree->topLevelItem(group)->child(row)->text(column);
  return texts;
}

QStringList shownResiduals(WindowFixture& test) {
  QStringList tables;
  for (const PlotPanel* const panel : test.child<ResidualsScreen>()->findChildren<PlotPanel*>())
    tables << panel->csv();
  return tables;
}

QPushButton* button(QWidget* parent, const QString& text) {
  for (QPushButton* const each : parent->findChildren<QPushButton*>())
    if (each->text().contains(text)) return each;
  return nullptr;
}

void waitForResiduals(WindowFixture& test, const std::function<void()>& act) {
  QSignalSpy ready(test.child<ResidualsScreen>(), &ResidualsScreen::ready);
  act();
  QVERIFY(!ready.isEmpty() || ready.wait(kPatience_ms));
}

}  // namespace

class TestKeptRuns : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  QString session_;  // a separate copy, with runs next to it after the story

  QString runs() const { return scratch_.filePath("session.runs"); }
  QStringList folders() const {
    return QDir(runs()).entryList(QDir::Dirs | QDir::NoDotAndDotDot, QDir::Name);
  }

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    session_ = copyWithRecording(scratch_.path());
  }
  void init() { QSettings().clear(); }

  void rejection_isUndone_andEveryRunIsKept() {
    WindowFixture test;
    test.window.files().open(session_);
    waitForResiduals(test, [&] {
      test.window.calibrate();
      QCOMPARE(test.waitForJob(), JobOutcome::Done);
    });
    const auto first = test.document().last().run;
    QTRY_VERIFY(!shownNumbers(test).isEmpty());
    const QStringList numbers = shownNumbers(test), residuals = shownResiduals(test);
    QVERIFY(!test.document().undoStack().canUndo());

    auto* const screen = test.child<ResidualsScreen>();
    screen->setThreshold(0.9 * screen->threshold_px());
    while (screen->rejectedWindows().empty()) screen->setThreshold(0.9 * screen->threshold_px());
    const auto rejected = static_cast<int>(screen->rejectedWindows().size());
    waitForResiduals(test, [&] {
      emit screen->recalibrateWithout(screen->rejectedWindows());
      QCOMPARE(test.waitForJob(), JobOutcome::Done);
    });
    const auto second = test.document().last().run;
    QVERIFY(second != first);
    QCOMPARE(static_cast<int>(second->result.rejected_windows.size()), rejected);
    QTRY_VERIFY(shownNumbers(test) != numbers);
    const QStringList numbers_after = shownNumbers(test);

    test.finished.clear();
    waitForResiduals(test, [&] { test.press(Qt::Key_Z, Qt::ControlModifier); });
    QVERIFY(test.document().last().run == first);
    QTRY_COMPARE(shownNumbers(test), numbers);
    QCOMPARE(shownResiduals(test), residuals);
    QVERIFY(
        test.window.isWindowModified());  // rejected windows are a step of their own, saved with the session
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QTRY_VERIFY(!test.window.isWindowModified());
    test.press(Qt::Key_Y, Qt::ControlModifier);
    waitForResiduals(test, [&] { test.press(Qt::Key_Y, Qt::ControlModifier); });
    QVERIFY(test.document().last().run == second);
    QTRY_COMPARE(shownNumbers(test), numbers_after);
    QVERIFY(test.finished.isEmpty());  // nothing was computed for it

    QTRY_COMPARE_WITH_TIMEOUT(folders().size(), 2, kPatience_ms);
    QTRY_COMPARE_WITH_TIMEOUT(test.child<RunsPanel>()->findChild<QTreeWidget*>()->topLevelItemCount(), 2,
                              kPatience_ms);
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  void savedRun_opensWithEverything_data() {
    QTest::addColumn<QString>("how");
    QTest::newRow("folder") << "folder";
    QTest::newRow("file") << "file";
    QTest::newRow("dropped") << "dropped";
  }

  void savedRun_opensWithEverything() {
    QFETCH(const QString, how);
    const QString folder = QDir(runs()).filePath(folders().at(1));
    const SavedRun saved = readSavedRun(folder.toStdString());
    WindowFixture test;
    QSignalSpy opened(&test.window.files(), &SessionFiles::opened);
    waitForResiduals(test, [&] {
      if (how == "dropped")
        drop(test, folder);
      else
        test.window.files().open(how == "file" ? folder + "/result.yaml" : folder);
      QVERIFY(opened.wait(kPatience_ms));
    });
    QCOMPARE(test.screen(), QString("result"));
    QVERIFY2(!test.child<ErrorPanel>()->isVisible(), qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(!test.window.isWindowModified());
    QCOMPARE(QFileInfo(test.document().file()), QFileInfo(session_));
    const CalibrationRun& run = *test.document().last().run;
    QCOMPARE(run.result.circle_residuals.size(), saved.run->result.circle_residuals.size());
    QVERIFY(!shownNumbers(test).isEmpty());
    // Identical twice: the drawing depends on nothing else.
    const QStringList numbers = shownNumbers(test), residuals = shownResiduals(test);
    QVERIFY(residuals.join("").size() > 1000);
    WindowFixture again;
    waitForResiduals(again, [&] { again.document().openRun({saved.run, saved.session, {}}); });
    QTRY_COMPARE(shownNumbers(again), numbers);
    QCOMPARE(shownResiduals(again), residuals);
    QVERIFY(again.window.close());
    // Marks of the detections, on the page of the recording.
    test.window.showScreen("detection");
    QTRY_VERIFY_WITH_TIMEOUT(test.child<DetectionScreen>()->timeline().windowAt(2.0).has_value(),
                             kPatience_ms);
    QVERIFY(test.window.close());
  }

  void recentFile_opensWithItsNewestRun() {
    WindowFixture test;
    test.window.files().openRecent(session_);
    QTRY_VERIFY_WITH_TIMEOUT(test.document().last().run != nullptr, kPatience_ms);
    QCOMPARE(test.document().last().run->result.rejected_windows.size(),
             readSavedRun(QDir(runs()).filePath(folders().at(1)).toStdString())
                 .run->result.rejected_windows.size());
    QVERIFY(!test.document().runIsOutdated());
    QVERIFY(!test.window.isWindowModified());
    test.window.files().open(session_);  // opened by its name: a new start
    spin(500);
    QVERIFY(!test.document().last().run);
    QVERIFY(test.window.close());
  }

  void sessionWithoutFile_keepsItsRuns_andTakesThemAlong() {
    const SavedRun saved = readSavedRun(QDir(runs()).filePath(folders().at(0)).toStdString());
    const QString file = scratch_.filePath("later/named.yaml");
    QVERIFY(QDir().mkpath(scratch_.filePath("later")));
    RunHistory history;
    history.setSession({}, saved.session.recording);
    QVERIFY(!QString::fromStdString(history.place().string()).startsWith(scratch_.path()));
    for (int k = 0; k < 2; ++k) history.keep(saved.run, saved.session, "0.0.0", {});  // in the same second
    QTRY_COMPARE_WITH_TIMEOUT(history.runs().size(), std::size_t{2}, kPatience_ms);
    const std::filesystem::path before = history.runs().front().folder;
    history.moveTo(file);
    const QDir beside(scratch_.filePath("later/named.runs"));
    QTRY_COMPARE_WITH_TIMEOUT(beside.entryList(QDir::Dirs | QDir::NoDotAndDotDot).size(), 2, kPatience_ms);
    QTRY_VERIFY(history.runs().size() == 2 && history.runs().front().folder != before);
    QVERIFY(!std::filesystem::exists(before));
    QVERIFY(runData(*readSavedRun(history.runs().front().folder).run) == runData(*saved.run));
  }

  void history_opensComparesNamesAndDeletes() {
    WindowFixture test;
    test.window.files().open(session_);
    auto* const panel = test.child<RunsPanel>();
    auto* const list = panel->findChild<QTreeWidget*>();
    QTRY_COMPARE_WITH_TIMEOUT(list->topLevelItemCount(), 2, kPatience_ms);
    QVERIFY(list->topLevelItem(0)->text(3).toInt() > 0);  // the newest first, with its rejected windows
    QVERIFY(list->topLevelItem(0)->text(5).contains("event windows rejected"));
    test.press(Qt::Key_H, Qt::ControlModifier);
    QTRY_VERIFY(panel->isVisible());

    list->setCurrentItem(list->topLevelItem(1));
    waitForResiduals(test, [&] { QTest::mouseClick(button(panel, "Open"), Qt::LeftButton); });
    QVERIFY(test.document().last().run->result.rejected_windows.empty());
    QTRY_VERIFY(list->topLevelItem(1)->font(0).bold());

    list->setCurrentItem(list->topLevelItem(0));
    QTest::mouseClick(button(panel, "Compare"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(test.document().reference().has_value(), kPatience_ms);
    QCOMPARE(test.screen(), QString("result"));
    QTRY_VERIFY(!test.child<ResultScreen>()->findChild<QTreeWidget*>()->isColumnHidden(4));

    emit panel->renameRequested(QDir(runs()).filePath(folders().at(1)), "without blur");
    QTRY_COMPARE_WITH_TIMEOUT(list->topLevelItem(0)->text(0), QString("without blur"), kPatience_ms);

    takePictures(test, "kept_runs");
    list->setCurrentItem(list->topLevelItem(0));
    answerQuestion(QMessageBox::Cancel);
    QTest::mouseClick(button(panel, "Delete"), Qt::LeftButton);
    QCOMPARE(folders().size(), 2);
    answerQuestion(QMessageBox::Yes);
    QTest::mouseClick(button(panel, "Delete"), Qt::LeftButton);
    QTRY_COMPARE_WITH_TIMEOUT(list->topLevelItemCount(), 1, kPatience_ms);
    QCOMPARE(folders().size(), 1);
    QVERIFY(test.window.close());
  }

  void missingRecording_isAskedFor() {
    const QString folder = QDir(runs()).filePath(folders().at(0));
    const QString recording = scratch_.filePath("recording.bag"), moved = scratch_.filePath("moved.bag");
    QVERIFY(QFile::rename(recording, moved));
    WindowFixture test;
    waitForResiduals(test, [&] {
      test.window.files().open(folder);
      QTRY_VERIFY2_WITH_TIMEOUT(test.document().hasSession(), qPrintable(test.child<ErrorPanel>()->text()),
                                kPatience_ms);
    });
    QCOMPARE(test.screen(), QString("result"));
    QVERIFY(!shownNumbers(test).isEmpty());
    test.window.showScreen("detection");
    auto* const screen = test.child<DetectionScreen>();
    QPushButton* const look = button(screen, "Find the recording");
    QTRY_VERIFY_WITH_TIMEOUT(look && look->isVisible(), kPatience_ms);
    QVERIFY(screen->timeline().windowAt(2.0).has_value());  // detections are marked without it
    takePictures(test, "missing_recording");
    answerFileDialog(moved);
    QTest::mouseClick(look, Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(!look->isVisible() && screen->analysis(), kPatience_ms);
    QCOMPARE(test.document().session().recording.filename().string(), std::string("moved.bag"));
    QVERIFY(!test.document().runIsOutdated());
    QVERIFY(QFile::rename(moved, recording));
    answerQuestion(QMessageBox::Discard);  // the session names another recording now
    QVERIFY(test.window.close());
  }

  void damagedFolder_showsWhatIsThere() {
    const QString folder = scratch_.filePath("damaged");
    std::filesystem::copy(QDir(runs()).filePath(folders().at(0)).toStdString(), folder.toStdString(),
                          std::filesystem::copy_options::recursive);
    QVERIFY(QFile::resize(folder + "/run.data", 1000));
    WindowFixture test;
    QSignalSpy opened(&test.window.files(), &SessionFiles::opened);
    test.window.files().open(folder);
    QVERIFY(opened.wait(kPatience_ms));
    auto* const error = test.child<ErrorPanel>();
    QTRY_VERIFY(error->isVisible());
    QVERIFY2(error->text().contains("The run is incomplete"), qPrintable(error->text()));
    QVERIFY2(error->text().contains("trajectory"), qPrintable(error->text()));
    QTRY_VERIFY(!shownNumbers(test).isEmpty());
    for (const QString& name : test.window.screenNames()) {
      test.window.showScreen(name);
      spin(50);
    }
    QVERIFY(test.window.close());

    QVERIFY(QFile::remove(folder + "/result.yaml"));
    WindowFixture none;
    none.window.files().open(folder);
    QTRY_VERIFY_WITH_TIMEOUT(none.child<ErrorPanel>()->isVisible(), kPatience_ms);
    QVERIFY(!none.document().hasSession());
    QVERIFY(none.window.close());
  }

 private:
  // For visual inspection.
  static void takePictures(WindowFixture& test, const QString& name) {
    for (const bool dark : {false, true}) {
      applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
      for (const QSize& size : {QSize(1024, 700), QSize(1280, 800), QSize(1920, 1080)}) {
        test.window.resize(size);
        spin(200);
        QVERIFY(test.window.grab().save(
            screenshotPath("%1_%2_%3.png").arg(name).arg(size.width()).arg(dark ? "dark" : "light")));
      }
    }
    applyTheme(*qApp, Appearance::Light);
  }
  static void drop(WindowFixture& test, const QString& path) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(path)});
    QDragEnterEvent enter(QPoint(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&test.window, &enter);
    QDropEvent event(QPointF(200, 200), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&test.window, &event);
  }
};

EVICAL_TEST(TestKeptRuns)
#include "tst_kept_runs.moc"
