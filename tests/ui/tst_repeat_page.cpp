// SPDX-License-Identifier: GPL-3.0-or-later
// Story of a user with several recordings of one rig: all are calibrated, one does not fit, two are compared.
#include "core/report/repeat_comparison.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/page_pictures.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/slowdown.h"
#include "tests/ui/unnamed_controls.h"
#include "tests/ui/window_fixture.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/repeat_screen.h"
#include "ui/screens/assessment/repeat_table.h"
#include "ui/window/error_panel.h"
#include "ui/window/session_files.h"

#include <QComboBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QTabWidget>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestRepeatPage : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  static QPushButton* button(WindowFixture& test, const char* name) {
    return test.child<RepeatScreen>()->findChild<QPushButton*>(name);
  }
  static void type(WindowFixture& test, const QString& folder) {
    auto* const edit = test.child<RepeatScreen>()->findChild<QLineEdit*>("repeat_folder");
    edit->setFocus();
    edit->selectAll();
    QTest::keyClicks(edit, folder);
  }
  static void choose(QComboBox* box, const QString& text) {
    box->setCurrentText(text);
    emit box->activated(box->currentIndex());
  }

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }
  void cleanup() { applyTheme(*qApp, Appearance::Light); }

  void whatIsMissing_isSaidBesideTheButton() {
    WindowFixture test;
    test.press(Qt::Key_0, Qt::ControlModifier);
    QCOMPARE(test.screen(), QString("repeat"));
    auto* const screen = test.child<RepeatScreen>();
    QVERIFY(!button(test, "start_repeat")->isEnabled() && !button(test, "add_open")->isEnabled());
    QVERIFY(button(test, "start_repeat")->toolTip().contains("at least two"));
    screen->files().add({"/no/such/a.bag"});
    QVERIFY(button(test, "start_repeat")->toolTip().contains("at least two"));
    screen->files().add({"/no/such/b.bag", "/no/such/a.bag"});
    QCOMPARE(screen->files().files().size(), 2);
    QVERIFY(button(test, "start_repeat")->isEnabled());
    type(test, {});
    QTest::keyClick(screen->findChild<QLineEdit*>("repeat_folder"), Qt::Key_Delete);
    QVERIFY(button(test, "start_repeat")->toolTip().contains("folder for the results"));
    type(test, scratch_.filePath("nowhere"));
    QTest::mouseClick(button(test, "start_repeat"), Qt::LeftButton);
    QVERIFY(!test.runner().running());
    QVERIFY2(test.child<ErrorPanel>()->text().contains("without a description"),
             qPrintable(test.child<ErrorPanel>()->text()));
    auto* const list = screen->findChild<QListWidget*>("list_recordings");
    list->setCurrentRow(0);
    list->setFocus();
    QTest::keyClick(list, Qt::Key_Delete);
    QCOMPARE(screen->files().files(), QStringList{"/no/such/b.bag"});
  }

  void story() {
    WindowFixture test;
    test.window.files().open(simulatedFurtherSession(1));
    QTRY_VERIFY(test.document().hasSession());
    test.window.showScreen("repeat");
    auto* const screen = test.child<RepeatScreen>();
    QTest::mouseClick(button(test, "add_open"), Qt::LeftButton);
    // A session, and a recording that is used with the open rig.
    const QString recording = QFileInfo(simulatedFurtherSession(2)).dir().filePath("recording.bag");
    screen->files().add({recording, simulatedFurtherSession(4), simulatedFurtherSession(3, 1.5)});
    const QString folder = scratch_.filePath("together");
    type(test, folder);
    cancelled(test);
    const RepeatJob& job = test.window.workbench().repeat;
    QSignalSpy done(&job, &TaskJob::done);
    QTest::mouseClick(button(test, "start_repeat"), Qt::LeftButton);
    QVERIFY2(test.waitForJob() == JobOutcome::Done, qPrintable(test.child<ErrorPanel>()->text()));
    QCOMPARE(done.size(), 1);
    const Repeatability& repeat = job.found()->run.repeatability;
    QVERIFY2(repeat.verdict == Verdict::Changed, repeat.reason.c_str());
    QVERIFY(repeat.recordings.at(3).outcome == RepeatOutcome::DoesNotFit);
    shows(test, repeat);
    compares(test, repeat);
    for (const char* const file : {"repeat.yaml", "repeat.csv", "report.html", "result.yaml", "log.txt"})
      QVERIFY2(QFileInfo(QDir(folder).filePath(file)).size() > 0, file);
    QVERIFY(unnamedControls(*screen).isEmpty());
    keepPictures(test, "repeat_numbers");
    screen->findChild<QTabWidget*>("repeat_tabs")->setCurrentIndex(1);
    applyTheme(*qApp, Appearance::Dark);
    keepPictures(test, "repeat_recordings");
    opensOne(test);
    QVERIFY(test.window.close());
  }

  void session_thatIsNotSaved_isToBeSavedFirst() {
    WindowFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QTRY_VERIFY(test.document().hasSession());
    test.document().setOption("grid.min_circles", "9");
    test.child<RepeatScreen>()->files().add({test.document().file(), simulatedFurtherSession(2)});
    test.window.showScreen("repeat");
    QTest::mouseClick(button(test, "start_repeat"), Qt::LeftButton);
    QVERIFY(!test.runner().running());
    QVERIFY2(test.child<ErrorPanel>()->text().contains("Save the session first"),
             qPrintable(test.child<ErrorPanel>()->text()));
    test.document().undoStack().setClean();
  }

 private:
  void cancelled(WindowFixture& test) {
    QTest::mouseClick(button(test, "start_repeat"), Qt::LeftButton);
    QVERIFY2(test.runner().running(), qPrintable(test.child<ErrorPanel>()->text()));
    spin(300);
    const ComputedTime since_cancel;
    QTest::mouseClick(button(test, "cancel_repeat"), Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY2(since_cancel.elapsed_ms() < maxAfterCancel_ms(),
             qPrintable(QString::number(since_cancel.elapsed_ms())));
  }
  void shows(WindowFixture& test, const Repeatability& repeat) {
    auto* const screen = test.child<RepeatScreen>();
    QCOMPARE(screen->findChild<QLabel*>("repeat_verdict")->text(), QString("The recordings disagree"));
    QVERIFY(screen->findChild<QLabel*>("repeat_reason")->text().contains("rotation"));
    const auto* const list = test.child<RepeatedList>();
    QCOMPARE(list->topLevelItemCount(), 4);
    QCOMPARE(list->topLevelItem(3)->text(RepeatedList::kOutcome), QString("does not fit"));
    QCOMPARE(list->topLevelItem(1)->text(RepeatedList::kOutcome), QString("fits"));
    const auto* const table = test.child<RepeatTable>();
    QCOMPARE(table->topLevelItemCount(), static_cast<int>(repeat.quantities.size()));
    const RepeatedNumber& number = repeat.quantities.front().numbers.front();
    const QTreeWidgetItem& row = *table->topLevelItem(0)->child(0);
    QVERIFY(std::abs(row.text(RepeatTable::kRatio).toDouble() - number.ratio()) < 0.006);
    QVERIFY(std::abs(row.text(RepeatTable::kMean).toDouble() - number.mean) < 0.1 * number.deviation);
    QVERIFY(table->isColumnHidden(RepeatTable::kDifference));
  }
  void compares(WindowFixture& test, const Repeatability& repeat) {
    auto* const screen = test.child<RepeatScreen>();
    choose(screen->findChild<QComboBox*>("first_of_pair"), QString::fromStdString(repeat.columns.at(3)));
    choose(screen->findChild<QComboBox*>("second_of_pair"), "all together");
    const auto* const table = test.child<RepeatTable>();
    QVERIFY(!table->isColumnHidden(RepeatTable::kDifference));
    const RepeatedNumber& number = repeat.quantities.front().numbers.front();
    const auto expected = differenceOf(repeat, number, 3, kAllTogether);
    const double sigmas = table->topLevelItem(0)->child(0)->text(RepeatTable::kSigmas).toDouble();
    QVERIFY(expected && std::abs(sigmas - expected->value / expected->sigma) < 0.06);
  }
  void opensOne(WindowFixture& test) {
    auto* const list = test.child<RepeatedList>();
    list->topLevelItem(1)->setSelected(true);
    QTest::mouseClick(button(test, "open_recording_result"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(test.document().last().run, kPatience_ms);
    QTRY_COMPARE(test.screen(), QString("result"));
  }
};

EVICAL_TEST(TestRepeatPage)
#include "tst_repeat_page.moc"
