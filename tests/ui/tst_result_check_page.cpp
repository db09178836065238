// SPDX-License-Identifier: GPL-3.0-or-later
// Story of a user with an earlier calibration: a new recording is compared with the old result.
#include "core/report/assessment_report.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/page_pictures.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/slowdown.h"
#include "tests/ui/unnamed_controls.h"
#include "tests/ui/window_fixture.h"
#include "ui/screens/assessment/finding_table.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/result_check_screen.h"
#include "ui/window/error_panel.h"
#include "ui/window/session_files.h"

#include <QGridLayout>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestResultCheckPage : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  QString session_;

  static QString field(WindowFixture& test, const char* name) {
    return test.child<ResultCheckScreen>()->findChild<QLineEdit*>(name)->text();
  }
  static void type(WindowFixture& test, const char* name, const QString& text) {
    auto* const edit = test.child<ResultCheckScreen>()->findChild<QLineEdit*>(name);
    edit->setFocus();
    edit->selectAll();
    QTest::keyClicks(edit, text);
  }
  static QPushButton* button(WindowFixture& test, const char* name) {
    return test.child<ResultCheckScreen>()->findChild<QPushButton*>(name);
  }
  // With a run to check, kept next to the session's file.
  void calibrate(WindowFixture& test) {
    test.window.files().open(session_);
    QTRY_VERIFY(test.document().hasSession());
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QTRY_VERIFY_WITH_TIMEOUT(!test.window.workbench().history.runs().empty(), kPatience_ms);
    test.press(Qt::Key_9, Qt::ControlModifier);
    QCOMPARE(test.screen(), QString("check-result"));
  }
  // Presses the page's own button.
  static void check(WindowFixture& test, const QString& recording) {
    type(test, "new_recording", recording);
    QPushButton* const start = button(test, "start_check_result");
    QVERIFY2(start->isEnabled(), qPrintable(start->toolTip()));
    QTest::mouseClick(start, Qt::LeftButton);
    QVERIFY(test.runner().running());
  }
  static const QTreeWidgetItem* rowOf(WindowFixture& test, const QString& title) {
    const auto* const table = test.child<ResultCheckScreen>()->findChild<FindingTable*>();
    for (int row = 0; row < table->topLevelItemCount(); ++row)
      if (table->topLevelItem(row)->text(0).contains(title)) return table->topLevelItem(row);
    return nullptr;
  }

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    session_ = scratch_.filePath("session.yaml");
    const Session session = readSession(simulatedFurtherSession(1).toStdString());
    writeSession(session, session_.toStdString());
  }
  void init() { QSettings().clear(); }
  void cleanup() { applyTheme(*qApp, Appearance::Light); }

  void withoutAResult_itSaysWhatItNeeds() {
    WindowFixture test;
    test.window.showScreen("check-result");
    QVERIFY(!button(test, "start_check_result")->isEnabled());
    QCOMPARE(button(test, "start_check_result")->toolTip(), QString("Choose the old result"));
    type(test, "old_result", "/no/such/result");
    QCOMPARE(button(test, "start_check_result")->toolTip(), QString("Choose the new recording"));
    check(test, simulatedFurtherSession(2));
    QCOMPARE(test.waitForJob(), JobOutcome::Failed);
    QVERIFY2(test.child<ErrorPanel>()->text().contains("/no/such/result"),
             qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(button(test, "start_check_result")->isEnabled());
  }

  // An open recording without a result is the new recording.
  void openRecording_isProposed() {
    WindowFixture test;
    test.window.files().open(session_);
    QTRY_VERIFY(test.document().hasSession());
    QCOMPARE(field(test, "new_recording"), session_);
    QVERIFY(field(test, "old_result").isEmpty());
  }

  void run_isShownByItsTitle_withItsPathAsToolTip() {
    QWidget page;
    auto* const grid = new QGridLayout(&page);
    OldResultRow row("row", *grid, &page);
    const auto* const field = page.findChild<QLineEdit*>("row");
    const QString tip = field->toolTip();
    row.setKeptRuns({{"Run of today: ok", "/runs/1"}});
    row.proposePath("/runs/1");
    QCOMPARE(field->text(), QString("Run of today: ok"));
    QVERIFY(field->toolTip().startsWith(QDir::toNativeSeparators("/runs/1") + '\n'));
    QCOMPARE(row.path(), QString("/runs/1"));
    row.setKeptRuns({{"Best: ok", "/runs/1"}});  // renamed
    QCOMPARE(field->text(), QString("Best: ok"));
    QCOMPARE(row.path(), QString("/runs/1"));
    row.setPath("/another/result");
    QCOMPARE(field->text(), QDir::toNativeSeparators("/another/result"));
    QCOMPARE(field->toolTip(), tip);
  }

  void story() {
    WindowFixture test;
    calibrate(test);
    const OldResultRow& result = test.child<ResultCheckScreen>()->result();
    QTRY_VERIFY_WITH_TIMEOUT(field(test, "old_result").startsWith("Run of "), kPatience_ms);
    QVERIFY(QFile::exists(result.path() + "/result.yaml"));
    QVERIFY(field(test, "new_recording").isEmpty());  // the result's own recording gives no new information
    cancelled(test);

    const ResultCheckJob& job = test.window.workbench().result_check;
    QSignalSpy done(&job, &TaskJob::done);
    check(test, simulatedFurtherSession(2));
    QVERIFY(button(test, "cancel_check_result")->isVisible() &&
            !button(test, "start_check_result")->isVisible());
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QCOMPARE(done.size(), 1);
    const auto same = job.found();
    QVERIFY2(same->run.check.verdict != Verdict::Changed, same->run.check.reason.c_str());
    shows(test, same->run.check);
    keepPictures(test, "check_result_same");
    saved(test);

    check(test, simulatedFurtherSession(3, 1.5));
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QCOMPARE(done.size(), 2);
    const auto turned = job.found();
    QVERIFY2(turned->run.check.verdict == Verdict::Changed, turned->run.check.reason.c_str());
    shows(test, turned->run.check);
    QCOMPARE(rowOf(test, "rotation")->text(FindingTable::kVerdict), QString("changed"));
    QVERIFY(unnamedControls(*test.child<ResultCheckScreen>()).isEmpty());
    applyTheme(*qApp, Appearance::Dark);
    keepPictures(test, "check_result_changed");
    QVERIFY(test.window.close());
  }

 private:
  void cancelled(WindowFixture& test) {
    check(test, simulatedFurtherSession(2));
    spin(300);
    const ComputedTime since_cancel;
    QTest::mouseClick(button(test, "cancel_check_result"), Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY2(since_cancel.elapsed_ms() < maxAfterCancel_ms(),
             qPrintable(QString::number(since_cancel.elapsed_ms())));
    QVERIFY(button(test, "start_check_result")->isVisible());
  }
  void shows(WindowFixture& test, const CalibrationCheck& check) {
    auto* const screen = test.child<ResultCheckScreen>();
    const QString verdict = screen->findChild<QLabel*>("check_result_verdict")->text();
    QCOMPARE(verdict.toLower(), QString(verdictWords(check.verdict)));
    const QString reason = QString::fromStdString(check.reason);
    QVERIFY(screen->findChild<QLabel*>("check_result_reason")->text().contains(reason.mid(1)));
    const auto* const table = test.child<ResultCheckScreen>()->findChild<FindingTable*>();
    QCOMPARE(table->topLevelItemCount(), static_cast<int>(check.findings.size()));
    for (std::size_t k = 0; k < check.findings.size(); ++k) {
      const QTreeWidgetItem& row = *table->topLevelItem(static_cast<int>(k));
      QCOMPARE(row.childCount(), static_cast<int>(check.findings[k].numbers.size()));
      const QStringList test = row.text(FindingTable::kTest).split(" of ");  // value and limit
      QCOMPARE(test.size(), 2);
      QVERIFY(std::abs(test[0].toDouble() - check.findings[k].sigmas) < 0.06);
      QVERIFY(std::abs(test[1].toDouble() - check.findings[k].limit_sigmas) < 0.06);
      QVERIFY(!row.text(FindingTable::kDetectable).isEmpty() && !row.text(FindingTable::kChange).isEmpty());
    }
    QVERIFY(table->allText().contains("Detectable"));
    test.window.resize(1280, 800);
    spin(100);
    const int end_px =
        table->columnViewportPosition(FindingTable::kNow) + table->columnWidth(FindingTable::kNow);
    QVERIFY2(end_px <= table->viewport()->width(), qPrintable(QString::number(end_px)));
    QVERIFY(screen->findChild<QListWidget*>("check_result_notes")->count() >=
            static_cast<int>(check.advice.size() + check.notes.size()));
  }
  void saved(WindowFixture& test) {
    const QString folder = scratch_.filePath("checked");
    QDir().mkpath(folder);
    answerFileDialog(folder);
    QTest::mouseClick(button(test, "save_check_result"), Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (const char* const name : {"check.yaml", "report.html", "log.txt"})
      QVERIFY2(QFileInfo(QDir(folder).filePath(name)).size() > 0, name);
    QVERIFY(test.child<ExportNotice>()->text().contains("The check was saved"));
  }
};

EVICAL_TEST(TestResultCheckPage)
#include "tst_result_check_page.moc"
