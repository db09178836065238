// SPDX-License-Identifier: GPL-3.0-or-later
// The list of windows in the main window: rejections apply to the next run and can be undone; a residual
// leads to its window.
#include "core/frontend/detection_options.h"
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/timeline.h"
#include "ui/detection/window_list.h"
#include "ui/plots/plot_panel.h"
#include "ui/plots/residuals_screen.h"
#include "ui/window/session_files.h"

#include <QDialog>
#include <QLabel>
#include <QRegularExpression>
#include <QShortcut>
#include <QTextBrowser>
#include <QTreeView>

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

struct Story : WindowFixture {
  explicit Story(const QString& session) {
    window.files().open(session);
    window.calibrate();
    QCOMPARE(waitForJob(), JobOutcome::Done);
    window.showScreen("detection");
    if (!list().isVisible()) press(Qt::Key_W);
    QVERIFY(list().isVisible());
    QTRY_VERIFY_WITH_TIMEOUT(list().model().rowCount() > 0, kPatience_ms);
  }
  DetectionScreen& detection() { return *child<DetectionScreen>(); }
  WindowList& list() { return detection().windowList(); }
  QTreeView& table() { return *child<QTreeView>("windows"); }
  int rejectedInRun() { return static_cast<int>(document().last().run->result.rejected_windows.size()); }
  int rejectedInList() {
    int count = 0;
    for (int row = 0; row < list().model().rowCount(); ++row) count += list().model().isRejected(row) ? 1 : 0;
    return count;
  }
  // Selects from the first to the last with Shift, then presses the key.
  void rejectRows(int first, int last, Qt::KeyboardModifiers modifiers = {}) {
    table().scrollTo(table().model()->index(first, 0), QAbstractItemView::PositionAtTop);
    const auto at = [&](int row) {
      return table().visualRect(table().model()->index(row, WindowListModel::State)).center();
    };
    QTest::mouseClick(table().viewport(), Qt::LeftButton, {}, at(first));
    QTest::mouseClick(table().viewport(), Qt::LeftButton, Qt::ShiftModifier, at(last));
    table().setFocus();
    QTest::keyClick(&table(), Qt::Key_Delete, modifiers);
  }
  void recalibrate() {
    finished.clear();
    const auto before = document().last().run;
    QSignalSpy stages(&runner(), &JobRunner::stageStarted);
    click("calibrate");
    QCOMPARE(waitForJob(), JobOutcome::Done);
    QVERIFY(document().last().run != before);
    for (const QList<QVariant>& stage : stages) QVERIFY(stage.at(0).toString() != "detect");  // not repeated
    window.showScreen("detection");
    QTRY_VERIFY_WITH_TIMEOUT(list().model().rowCount() > 0, kPatience_ms);
  }
};

}  // namespace

class TestMainWindowWindows : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }

  void windows_areRejectedAndKept_withUndo() {
    Story test(copyOfSimulatedSession(scratch_.path()));
    const auto first = test.document().last().run;
    const auto views = first->detections.cameras[0].views.size();
    QVERIFY(!test.document().undoStack().canUndo());
    test.rejectRows(20, 22);
    const int rejected = test.rejectedInList();
    QVERIFY(rejected >= 1);
    QVERIFY(test.document().rejectionsArePending());
    QVERIFY(test.window.isWindowModified());
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QCOMPARE(test.rejectedInList(), 0);
    test.press(Qt::Key_Y, Qt::ControlModifier);
    QCOMPARE(test.rejectedInList(), rejected);

    test.recalibrate();
    const auto second = test.document().last().run;
    QCOMPARE(test.rejectedInRun(), rejected);
    QCOMPARE(test.rejectedInList(), rejected);
    QCOMPARE(second->detections.cameras[0].views.size(), views - static_cast<std::size_t>(rejected));
    QVERIFY(!test.document().rejectionsArePending());

    // Undone permanently by another run; the measurements are the original ones.
    test.list().setFilter(WindowFilter::Rejected);
    test.rejectRows(0, rejected - 1, Qt::ShiftModifier);
    QCOMPARE(test.rejectedInList(), 0);
    test.recalibrate();
    QCOMPARE(test.rejectedInRun(), 0);
    QCOMPARE(test.document().last().run->detections.cameras[0].views.size(), views);
    const double before_px = first->result.cameras[0].reprojection_rms_px;
    QVERIFY(std::abs(test.document().last().run->result.cameras[0].reprojection_rms_px - before_px) <
            1e-3 * before_px);

    // Run, mark, run, mark: each is a step.
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(test.document().last().run == second);
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(!test.document().rejectionsArePending());
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(test.document().last().run == first);
    QVERIFY(test.document().rejectionsArePending());
    test.press(Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(!test.document().rejectionsArePending());
    QTRY_COMPARE_WITH_TIMEOUT(test.rejectedInList(), 0, kPatience_ms);

    clickOfABar_leadsToItsWindow(test);
    QVERIFY(test.window.close());
  }

  // Windows belong to the document: each calibration excludes them, also one that detects the board again,
  // and of sensors with other names.
  void rejectedWindows_areExcludedByEveryCalibration() {
    Story test(copyOfSimulatedSession(scratch_.path()));
    test.rejectRows(20, 22);
    const int rejected = test.rejectedInList();
    auto* const count = test.child<QLabel>("rejected_windows");
    QVERIFY2(count->text().contains(QString::number(rejected)), qPrintable(count->text()));
    test.recalibrate();
    const RejectedTimes times_s = test.document().rejections();

    Session changed = test.document().session();
    changed.cameras.front().name = "renamed";
    test.document().edit(changed, "Rename");
    QVERIFY(!test.document().runIsOutdated());
    changed.options.front_end.edit().grid.min_circles += 1;
    test.document().edit(changed, "Detect again");
    QSignalSpy stages(&test.runner(), &JobRunner::stageStarted);
    test.finished.clear();
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QVERIFY(std::any_of(stages.begin(), stages.end(),
                        [](const QList<QVariant>& stage) { return stage.at(0).toString() == "detect"; }));
    const auto& found = test.document().last().run->result.rejected_windows;
    QCOMPARE(static_cast<int>(found.size()), rejected);
    for (std::size_t k = 0; k < found.size(); ++k)
      QVERIFY(std::abs(found[k].time_s - times_s[0].at(k)) < 0.05);

    // Another run forgets nothing; the whole is undone.
    test.finished.clear();
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QCOMPARE(test.rejectedInRun(), rejected);
    test.document().undoStack().setIndex(0);
    QVERIFY(!test.document().rejectionsArePending());
    QVERIFY(count->text().isEmpty());
    test.document().undoStack().setClean();
    QVERIFY(test.window.close());
  }

  void rejectedWindows_areSavedWithTheSession() {
    const QString session = copyOfSimulatedSession(scratch_.path());
    int rejected = 0;
    {
      Story test(session);
      test.rejectRows(20, 22);
      rejected = test.rejectedInList();
      answerQuestion(QMessageBox::Cancel);
      QVERIFY(!test.window.close());
      test.press(Qt::Key_S, Qt::ControlModifier);
      QVERIFY(!test.window.isWindowModified());
      QVERIFY(test.window.close());
    }
    Story again(session);
    QVERIFY(rejected > 0);
    QCOMPARE(again.rejectedInRun(), rejected);
    QCOMPARE(again.rejectedInList(), rejected);
    QVERIFY(!again.document().rejectionsArePending() && !again.window.isWindowModified());
    QVERIFY(again.window.close());
  }

  void everyKeyOfDetection_isOnThePageOfKeys() {
    WindowFixture test;
    QTest::keyClick(&test.window, Qt::Key_Question);
    auto* const page = test.child<QDialog>("keys");
    QVERIFY(page && page->isVisible());
    QStringList lines = page->findChild<QTextBrowser*>()->toPlainText().split('\n');
    lines = lines.filter("Detection:");
    const QStringList keys = lines.join(", ").remove("Detection:").split(QRegularExpression("[,;] "));
    int found = 0;
    for (const QShortcut* const shortcut : test.child<DetectionScreen>()->findChildren<QShortcut*>()) {
      QString key = shortcut->key().toString();
      if (key == "Shift+Del" || key == "Del") key.replace("Del", "Delete");
      const auto is_key = [&](const QString& each) { return each.trimmed() == key; };
      QVERIFY2(std::any_of(keys.begin(), keys.end(), is_key), qPrintable(key + " of " + keys.join('|')));
      ++found;
    }
    QVERIFY(found >= 11);
  }

 private:
  static void clickOfABar_leadsToItsWindow(Story& test) {
    auto* const screen = test.child<ResidualsScreen>();
    test.window.showScreen("residuals");
    PlotPanel* bars = nullptr;
    QTRY_VERIFY_WITH_TIMEOUT(
        [&] {
          for (PlotPanel* const panel : screen->findChildren<PlotPanel*>())
            if (panel->isVisible() && panel->threshold()) bars = panel;
          return bars != nullptr;
        }(),
        kPatience_ms);
    auto* const chart = bars->findChild<QWidget*>();
    QTest::mouseClick(chart, Qt::LeftButton, {},
                      chart->mapFromParent(bars->pixelAt(2.0, 0.5 * screen->threshold_px()).toPoint()));
    const double time_s = test.detection().time_s();
    const auto& views = test.document().last().run->detections.cameras[0].views;
    QVERIFY(std::any_of(views.begin(), views.end(),
                        [&](const BoardView& view) { return view.time_s == time_s; }));
    QVERIFY(std::abs(time_s - 2.0) < 0.1);
    for (QToolButton* const button : screen->findChildren<QToolButton*>())
      if (button->text() == "Show window") QTest::mouseClick(button, Qt::LeftButton);
    QCOMPARE(test.screen(), QString("detection"));
    QCOMPARE(test.detection().time_s(), time_s);
    test.list().setFilter(WindowFilter::All);
    const std::vector<int> chosen = test.list().selectedWindows();
    QCOMPARE(chosen.size(), std::size_t{1});
    QCOMPARE(test.list().model().window(chosen.front()).report.time_s, time_s);
  }
};

EVICAL_TEST(TestMainWindowWindows)
#include "tst_main_window_windows.moc"
