// Story of a user without access to a board: logs of the IMUs are compared with the old result.
#include "core/pipeline/simulate/simulation.h"
#include "core/report/assessment_report.h"
#include "core/synthetic/drive_scenario.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/page_pictures.h"
#include "tests/ui/slowdown.h"
#include "tests/ui/unnamed_controls.h"
#include "tests/ui/window_fixture.h"
#include "ui/plots/maintenance_charts.h"
#include "ui/plots/plot_panel.h"
#include "ui/screens/assessment/file_list.h"
#include "ui/screens/assessment/finding_table.h"
#include "ui/screens/assessment/maintain_screen.h"
#include "ui/window/error_panel.h"
#include "ui/window/session_files.h"

#include <QComboBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QScrollBar>
#include <QTabWidget>
#include <QTreeWidgetItemIterator>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestMaintainPage : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  QString simulated(const char* scenario) {
    const QString folder = scratch_.filePath(scenario);
    if (QFile::exists(folder + "/truth.yaml")) return folder;
    DriveScenario drive = readDriveScenario(evical::test::scenarioPath(std::string("maintain/") + scenario));
    drive.duration_s = std::min(drive.duration_s, 1500.0);
    simulateDrive(drive, folder.toStdString(), RunContext{});
    return folder;
  }
  static MaintainScreen& page(WindowFixture& test) {
    test.window.showScreen("maintain");
    return *test.child<MaintainScreen>();
  }
  static void type(WindowFixture& test, const char* name, const QString& text) {
    auto* const edit = page(test).findChild<QLineEdit*>(name);
    edit->setFocus();
    edit->selectAll();
    QTest::keyClicks(edit, text);
  }
  static QPushButton* button(WindowFixture& test, const char* name) {
    return page(test).findChild<QPushButton*>(name);
  }
  // Through the dialog, the field, and the page's own button.
  static void look(WindowFixture& test, const QString& log, const QString& result) {
    answerFileDialog(log);
    QTest::mouseClick(button(test, "add_logs"), Qt::LeftButton);
    QCOMPARE(page(test).logs().files(), QStringList{log});
    type(test, "maintained_result", result);
    QPushButton* const start = button(test, "start_maintain");
    QVERIFY2(start->isEnabled(), qPrintable(start->toolTip()));
    QTest::mouseClick(start, Qt::LeftButton);
  }

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }
  void cleanup() { applyTheme(*qApp, Appearance::Light); }

  void key_opensIt() {
    WindowFixture test;
    test.press(Qt::Key_1, Qt::ControlModifier | Qt::ShiftModifier);
    QCOMPARE(test.screen(), QString("maintain"));
  }

  void withoutLogs_itSaysWhatItNeeds() {
    WindowFixture test;
    QPushButton* const start = button(test, "start_maintain");
    QVERIFY(!start->isEnabled());
    QCOMPARE(start->toolTip(), QString("Add the logs of the IMUs"));
    page(test).logs().add({"/no/such/log.bag"});
    QCOMPARE(start->toolTip(), QString("Choose the old result"));
    type(test, "maintained_result", "/no/such/result");
    QTest::mouseClick(start, Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Failed);
    QVERIFY2(test.child<ErrorPanel>()->text().contains("/no/such/result"),
             qPrintable(test.child<ErrorPanel>()->text()));
    QVERIFY(start->isEnabled());
    auto* const list = page(test).findChild<QListWidget*>("list_logs");
    list->item(0)->setSelected(true);
    list->setFocus();
    QTest::keyClick(list, Qt::Key_Delete);
    QVERIFY(page(test).logs().files().isEmpty() && !start->isEnabled());
  }

  void settings_areWhatTheFormSays() {
    WindowFixture test;
    MaintainScreen& screen = page(test);
    QVERIFY(!screen.settings().acceleration_unit && !screen.settings().angular_rate_unit);
    screen.findChild<QComboBox*>("acceleration_unit")->setCurrentText("-g");
    screen.findChild<QComboBox*>("angular_rate_unit")->setCurrentText("deg/s");
    type(test, "streams", "front=/a/imu, rear = b.csv");
    const ImuLogSettings settings = screen.settings();
    QVERIFY(settings.acceleration_unit == AccelerationUnit::MinusGravity);
    QVERIFY(settings.angular_rate_unit == AngularRateUnit::DegreesPerSecond);
    QCOMPARE(settings.streams.size(), std::size_t{2});
    QCOMPARE(settings.streams.at("front"), std::string("/a/imu"));
    QCOMPARE(settings.streams.at("rear"), std::string("b.csv"));
  }

  void streams_thatSayNothing_areRefused() {
    WindowFixture test;
    page(test).logs().add({"/no/such/log.bag"});
    type(test, "maintained_result", "/no/such/result");
    type(test, "streams", "front");
    QTest::mouseClick(button(test, "start_maintain"), Qt::LeftButton);
    QVERIFY(!test.runner().running());
    const QString text = test.child<ErrorPanel>()->text();
    QVERIFY2(text.contains("\"front\" is not NAME=STREAM"), qPrintable(text));
  }

  void story_somethingMoved() {
    WindowFixture test;
    const MaintainJob& job = test.window.workbench().maintain;
    QSignalSpy done(&job, &TaskJob::done);
    const QString folder = simulated("step_lever");
    look(test, folder + "/recording.bag", folder + "/calibration");
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    QCOMPARE(done.size(), 1);
    QVERIFY2(job.found()->verdict == Verdict::Changed, job.found()->reason.c_str());
    shows(test, *job.found());
    overTime(test, *job.found());
    QVERIFY(unnamedControls(page(test)).isEmpty());
    saved(test);
    keepPictures(test, "maintain_over_time");
    page(test).findChild<QTabWidget*>("maintain_tabs")->setCurrentIndex(0);
    applyTheme(*qApp, Appearance::Dark);
    keepPictures(test, "maintain_changed_dark");
    QVERIFY(test.window.close());
  }

  void story_stops() {
    WindowFixture test;
    const QString folder = simulated("drive_stops");
    look(test, folder + "/recording.bag", folder + "/calibration/result.yaml");
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    auto* const what = page(test).findChild<QComboBox*>("maintained_over_time");
    QCOMPARE(what->count(), 1);
    QVERIFY(what->currentText().startsWith("Stops of "));
    QCOMPARE(test.child<MaintenanceCharts>()->panels().size(), std::size_t{1});
    QVERIFY(test.child<MaintenanceCharts>()->panels().front()->csv().count('\n') > 12);
    page(test).findChild<QTabWidget*>("maintain_tabs")->setCurrentIndex(1);
    keepPictures(test, "maintain_stops");
  }

  void cancel_answersAtOnce() {
    WindowFixture test;
    const QString folder = simulated("three_imus_hour");
    look(test, folder + "/recording.bag", folder + "/calibration");
    spin(100);
    QVERIFY(test.runner().running());
    QVERIFY(button(test, "cancel_maintain")->isVisible() && !button(test, "start_maintain")->isVisible());
    const ComputedTime since_cancel;
    QTest::mouseClick(button(test, "cancel_maintain"), Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Cancelled);
    QVERIFY2(since_cancel.elapsed_ms() < maxAfterCancel_ms(),
             qPrintable(QString::number(since_cancel.elapsed_ms())));
    QVERIFY(button(test, "start_maintain")->isVisible());
  }

 private:
  void shows(WindowFixture& test, const Maintenance& maintenance) {
    MaintainScreen& screen = page(test);
    const QString verdict = screen.findChild<QLabel*>("maintain_verdict")->text();
    const bool now = std::ranges::any_of(maintenance.findings, &Finding::changed);
    if (maintenance.verdict == Verdict::Changed && !now)
      QCOMPARE(verdict, QString("Changed during the logs"));
    else
      QCOMPARE(verdict.toLower(), QString(verdictWords(maintenance.verdict)));
    const QString reason = QString::fromStdString(maintenance.reason);
    QVERIFY(screen.findChild<QLabel*>("maintain_reason")->text().contains(reason.mid(1)));
    const auto* const table = page(test).findChild<FindingTable*>();
    QCOMPARE(table->topLevelItemCount(), static_cast<int>(maintenance.findings.size()));
    for (std::size_t k = 0; k < maintenance.findings.size(); ++k) {
      const QTreeWidgetItem& row = *table->topLevelItem(static_cast<int>(k));
      const Finding& quantity = maintenance.findings[k];
      QCOMPARE(row.childCount(), static_cast<int>(quantity.numbers.size()));
      QCOMPARE(row.text(FindingTable::kVerdict), QString(verdictWords(quantity.verdict())));
    }
    test.window.resize(1280, 800);
    spin(100);
    const int end_px =
        table->columnViewportPosition(FindingTable::kNow) + table->columnWidth(FindingTable::kNow);
    QVERIFY2(end_px <= table->viewport()->width(), qPrintable(QString::number(end_px)));
    QCOMPARE(table->horizontalScrollBar()->maximum(), 0);  // the last column, too
    for (QTreeWidgetItemIterator row(const_cast<FindingTable*>(table)); *row; ++row)
      QVERIFY2(!(*row)->text(0).contains('_') && !(*row)->text(0).contains('^'), qPrintable((*row)->text(0)));
    const auto* const steps = test.child<StepTable>();
    QVERIFY(steps->isVisible());
    QCOMPARE(steps->topLevelItemCount(), 1);
    QVERIFY(steps->topLevelItem(0)->text(StepTable::kWhat).contains("rear against front"));
    QCOMPARE(steps->topLevelItem(0)->text(StepTable::kAt),
             QString("%1 s").arg(maintenance.steps.front().at_s, 0, 'f', 1));
    QVERIFY(screen.findChild<QListWidget*>("maintain_notes")->count() >=
            static_cast<int>(maintenance.advice.size() + maintenance.notes.size()));
  }
  // Five quantities of the pair; the jump of the lever arm is in its chart.
  void overTime(WindowFixture& test, const Maintenance& maintenance) {
    page(test).findChild<QTabWidget*>("maintain_tabs")->setCurrentIndex(1);
    auto* const charts = test.child<MaintenanceCharts>();
    auto* const what = page(test).findChild<QComboBox*>("maintained_over_time");
    QCOMPARE(what->itemText(0), QString("rear against front"));
    QCOMPARE(charts->panels().size(), std::size_t{5});
    const MaintenanceTrack& track = maintenance.tracks.front();
    QCOMPARE(track.quantities.size(), std::size_t{5});
    QCOMPARE(track.quantities[1].title, std::string("lever arm"));
    QVERIFY(charts->panels()[1]->csv().contains("x,"));
    what->setCurrentIndex(1);
    QVERIFY(what->currentText().startsWith("Stops of "));
    QCOMPARE(charts->panels().size(), std::size_t{1});
    what->setCurrentIndex(0);
  }
  void saved(WindowFixture& test) {
    const QString folder = scratch_.filePath("maintained");
    QDir().mkpath(folder);
    answerFileDialog(folder);
    QTest::mouseClick(button(test, "save_maintain"), Qt::LeftButton);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (const char* const name : {"maintenance.yaml", "report.html", "track1.csv", "stops.csv", "log.txt"})
      QVERIFY2(QFileInfo(QDir(folder).filePath(name)).size() > 0, name);
    QVERIFY(test.child<ExportNotice>()->text().contains("The maintenance of the IMUs was saved"));
  }
};

EVICAL_TEST(TestMaintainPage)
#include "tst_maintain_page.moc"
