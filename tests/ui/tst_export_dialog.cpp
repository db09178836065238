// SPDX-License-Identifier: GPL-3.0-or-later
// The export dialog: its proposals, remembered settings, refusals, and the report afterwards.
#include "ui/window/export_dialog.h"

#include "core/export/export_target.h"
#include "tests/support/test_program.h"
#include "tests/ui/screenshots.h"
#include "tests/ui/window_fixture.h"
#include "ui/window/error_panel.h"

#include <QCheckBox>
#include <QDesktopServices>
#include <QDialogButtonBox>
#include <QFile>
#include <QHeaderView>
#include <QLabel>
#include <QMap>
#include <QPushButton>

#include <algorithm>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestExportDialog : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  static QPushButton* okOf(const ExportDialog& dialog) {
    return dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
  }

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }

  void newFolder_isProposedBesideTheRecording() {
    const QString recording = scratch_.filePath("drive 1.bag");
    QVERIFY(QFile(recording).open(QIODevice::WriteOnly));
    QCOMPARE(newExportFolder(recording), scratch_.filePath("drive 1_calibration"));
    QVERIFY(QDir(scratch_.path()).mkdir("drive 1_calibration"));
    QCOMPARE(newExportFolder(recording), scratch_.filePath("drive 1_calibration_2"));
    QVERIFY(QDir(scratch_.path()).mkpath("tum.vie/events"));
    QCOMPARE(newExportFolder(scratch_.filePath("tum.vie")), scratch_.filePath("tum.vie_calibration"));
    QVERIFY(!newExportFolder("/no/such/folder/x.bag").startsWith("/no"));
  }

  void targets_areTheSessions_elseThoseOfTheLastExport() {
    Session session;
    session.recording = scratch_.filePath("a.bag").toStdString();
    QVERIFY(proposedExport(session).targets.empty());
    rememberExport({"/x", {"kalibr", "svo"}, true});
    QVERIFY((proposedExport(session).targets == std::vector<std::string>{"kalibr", "svo"}));
    QVERIFY(proposedExport(session).check);
    session.exports = {"ros"};
    QVERIFY((proposedExport(session).targets == std::vector<std::string>{"ros"}));
  }

  void buttons_selectAllWhatVioNeedsAndNone() {
    ExportDialog dialog({scratch_.filePath("new"), {"numpy"}, false}, nullptr);
    QVERIFY((dialog.request().targets == std::vector<std::string>{"kalibr", "numpy"}));
    dialog.findChild<QPushButton*>("select_all")->click();
    QCOMPARE(dialog.request().targets.size(), exportTargets().size());
    dialog.findChild<QPushButton*>("select_odometry")->click();
    for (const ExportTarget& target : exportTargets()) {
      const std::vector<std::string> chosen = dialog.request().targets;
      QCOMPARE(std::find(chosen.begin(), chosen.end(), target.name) != chosen.end(),
               target.inertial_odometry);
    }
    dialog.findChild<QPushButton*>("select_none")->click();
    QVERIFY((dialog.request().targets == std::vector<std::string>{"kalibr"}));  // always
    dialog.findChild<QCheckBox*>("check")->click();
    QVERIFY(dialog.request().check);
  }

  void eachTarget_hasItsLine_andVioIsMarked() {
    const ExportDialog dialog({scratch_.filePath("new"), {}, false}, nullptr);
    QMap<QString, const QTreeWidgetItem*> lines;
    for (QTreeWidgetItemIterator at(dialog.findChild<QTreeWidget*>("targets")); *at; ++at)
      lines[(*at)->data(0, Qt::UserRole).toString()] = *at;
    QVERIFY(lines.remove("") == 1);  // "More"
    QCOMPARE(static_cast<std::size_t>(lines.size()), exportTargets().size());
    for (const ExportTarget& target : exportTargets()) {
      QVERIFY(lines.contains(target.name));
      QVERIFY(lines[target.name]->text(1).contains(target.use));
      QCOMPARE(lines[target.name]->text(1).startsWith("VIO"), target.inertial_odometry);
    }
  }

  void rareTargets_areFolded_untilTheyAreWantedOrChosen() {
    ExportDialog dialog({scratch_.filePath("new"), {"openvins", "opencv"}, false}, nullptr);
    auto* const list = dialog.findChild<QTreeWidget*>("targets");
    QCOMPARE(list->topLevelItemCount(), 6);
    QTreeWidgetItem* const more = list->topLevelItem(5);
    QCOMPARE(more->text(0), QString("More (%1)").arg(exportTargets().size() - 5));
    QVERIFY(!more->isExpanded());
    dialog.show();
    for (const bool shown : {true, false}) {
      QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualItemRect(more).center());
      QCOMPARE(more->isExpanded(), shown);
    }
    dialog.findChild<QPushButton*>("select_all")->click();
    QVERIFY(more->isExpanded());
    const ExportDialog chosen({scratch_.filePath("new"), {"numpy"}, false}, nullptr);
    QVERIFY(chosen.findChild<QTreeWidget*>("targets")->topLevelItem(5)->isExpanded());
  }

  void columns_areWholeInAWindowOf1280() {
    ExportDialog dialog({scratch_.filePath("new"), {"numpy"}, false}, nullptr);
    dialog.resize(1240, 600);
    dialog.show();
    const auto* const list = dialog.findChild<QTreeWidget*>("targets");
    QVERIFY2(list->header()->length() <= list->viewport()->width(),
             qPrintable(QString::number(list->header()->length())));
    for (QTreeWidgetItemIterator at(dialog.findChild<QTreeWidget*>("targets")); *at; ++at)
      for (int column = 0; (*at)->parent() && column < list->columnCount(); ++column)
        QVERIFY2(list->fontMetrics().horizontalAdvance((*at)->text(column)) < list->columnWidth(column),
                 qPrintable((*at)->text(column)));
  }

  void folder_isJudgedWhileItIsTyped_data() {
    QTest::addColumn<QString>("folder");
    QTest::addColumn<QString>("hint");
    QTest::addColumn<bool>("usable");
    QVERIFY(QDir(scratch_.path()).mkdir("empty"));
    QVERIFY(QFile(scratch_.filePath("file")).open(QIODevice::WriteOnly));
    QTest::newRow("new") << scratch_.filePath("not/yet") << "will be created" << true;
    QTest::newRow("empty") << scratch_.filePath("empty") << "empty" << true;
    QTest::newRow("has files") << scratch_.path() << "are replaced" << true;
    QTest::newRow("file") << scratch_.filePath("file") << "is a file" << false;
    QTest::newRow("none") << "  "
                          << "Enter a folder" << false;
    QTest::newRow("relative") << "results"
                              << "absolute path" << false;
  }
  void folder_isJudgedWhileItIsTyped() {
    QFETCH(QString, folder);
    QFETCH(QString, hint);
    QFETCH(bool, usable);
    ExportDialog dialog({scratch_.filePath("new"), {}, false}, nullptr);
    dialog.findChild<QLineEdit*>("folder")->setText(folder);
    const QString said = dialog.findChild<QLabel*>("folder_hint")->text();
    QVERIFY2(said.contains(hint), qPrintable(said));
    QCOMPARE(okOf(dialog)->isEnabled(), usable);
    QCOMPARE(dialog.request().folder, folder.trimmed());
  }

  void notice_saysWhereAndWhatWasRefused() {
    ExportNotice notice;
    notice.showOutcome({"/tmp/drive_calibration", {"Kalibr", "OpenVINS"}, {}, true, {}});
    QVERIFY(notice.text().startsWith("The result was exported\nThe files are in /tmp/drive_calibration"));
    QVERIFY(notice.text().contains("Kalibr, OpenVINS") && notice.text().contains("all values agree"));
    notice.showOutcome(
        {"/tmp/x", {"Kalibr"}, {"esvo: not exported: has one camera"}, true, {"kalibr: does not read back"}});
    QVERIFY(notice.text().contains("not for all programs"));
    QVERIFY(notice.text().contains("esvo: not exported: has one camera"));
    QVERIFY(notice.text().contains("kalibr: does not read back") && !notice.text().contains("agree"));
    QTest::keyClick(&notice, Qt::Key_Escape);
    QVERIFY(notice.isHidden());
  }

  void screenshots() {
    for (const Appearance appearance : {Appearance::Light, Appearance::Dark}) {
      applyTheme(*qApp, appearance);
      ExportDialog dialog({scratch_.filePath("drive_calibration"), {"openvins", "ros"}, true}, nullptr);
      dialog.resize(1100, 600);
      dialog.show();
      ExportNotice notice;
      notice.showOutcome({"/data/drive_calibration",
                          {"Kalibr", "OpenVINS"},
                          {"esvo: not exported: result: has one camera, and ESVO needs two"},
                          true,
                          {}});
      notice.resize(760, notice.heightForWidth(760));
      for (QWidget* const widget : std::initializer_list<QWidget*>{&dialog, &notice})
        QVERIFY(widget->grab().save(screenshotPath("export_%1_%2.png")
                                        .arg(widget == &dialog ? "dialog" : "notice")
                                        .arg(theme().dark ? "dark" : "light")));
    }
    applyTheme(*qApp, Appearance::Light);
  }
};

EVICAL_TEST(TestExportDialog)
#include "tst_export_dialog.moc"
