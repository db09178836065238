// SPDX-License-Identifier: GPL-3.0-or-later
// Every control of every page and dialog has a name for screen readers.
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/unnamed_controls.h"
#include "tests/ui/window_fixture.h"
#include "ui/screens/board/print_board_dialog.h"
#include "ui/screens/recording/how_to_record_dialog.h"
#include "ui/window/about.h"
#include "ui/window/export_dialog.h"
#include "ui/window/print_board.h"
#include "ui/window/session_files.h"
#include "ui/window/user_guide.h"

#include <QCheckBox>
#include <QLabel>
#include <QSpinBox>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestAccessibleNames : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }

  void helper_findsWhatHasNoName() {
    QWidget window;
    auto* const field = new QLineEdit(&window);
    auto* const button = new QToolButton(&window);
    auto* const box = new QCheckBox("A choice", &window);
    QCOMPARE(unnamedControls(window).size(), 2);
    auto* const label = new QLabel("&Length", &window);
    label->setBuddy(field);
    QCOMPARE(unnamedControls(window).size(), 1);
    button->setAccessibleName("Dismiss");
    QVERIFY(unnamedControls(window).isEmpty());
    box->setText({});
    QCOMPARE(unnamedControls(window).size(), 1);
    new QSpinBox(&window);
    QCOMPARE(unnamedControls(window).size(), 2);
  }

  void pagesAndDocks_data() {
    QTest::addColumn<bool>("two_cameras");
    QTest::newRow("one camera") << false;
    QTest::newRow("two cameras") << true;
  }
  void pagesAndDocks() {
    QFETCH(bool, two_cameras);
    WindowFixture test;
    QStringList found = unnamedControls(test.window);
    test.window.files().open(two_cameras ? simulatedTwoCameraSession()
                                         : copyOfSimulatedSession(scratch_.path()));
    QTRY_VERIFY(test.document().hasSession());
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (const QString& page : test.window.screenNames()) {
      test.window.showScreen(page);
      spin(100);
    }
    found << unnamedControls(test.window);
    found.removeDuplicates();
    QVERIFY2(found.isEmpty(), qPrintable(found.join('\n')));
    test.document().undoStack().setClean();
  }

  void dialogs() {
    WindowFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    showPrintBoard(&test.window, test.window.workbench());
    showHowToRecord(&test.window);
    showUserGuide(&test.window);
    showKeys(&test.window);
    showAbout(&test.window, "0.0.0");
    const ExportDialog exporting(proposedExport(test.document().session()), &test.window);
    QStringList found;
    const QList<QDialog*> dialogs = test.window.findChildren<QDialog*>();
    QVERIFY2(dialogs.size() >= 6, qPrintable(QString::number(dialogs.size())));
    for (const QDialog* const dialog : dialogs) {
      QVERIFY(!dialog->windowTitle().isEmpty());
      found << unnamedControls(*dialog);
    }
    found.removeDuplicates();
    QVERIFY2(found.isEmpty(), qPrintable(found.join('\n')));
  }
};

EVICAL_TEST(TestAccessibleNames)
#include "tst_accessible_names.moc"
