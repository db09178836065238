// SPDX-License-Identifier: GPL-3.0-or-later
// Names in files are text: no label and no tool tip shows them as rich text, which would open the files that
// they name. A pipe would stop the window.
#include "core/pipeline/session/session.h"
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/forms/number_field.h"
#include "ui/theme/plain_labels.h"
#include "ui/window/print_board.h"
#include "ui/window/session_files.h"

#include <QHelpEvent>
#include <QLabel>
#include <QTextEdit>
#include <QToolTip>

#include <sys/stat.h>

#include <cmath>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

// Labels that show rich text by accident, and documents with the picture.
QStringList richTexts() {
  QStringList found;
  for (QWidget* const widget : QApplication::allWidgets()) {
    const QString place = QString("%1 %2: ").arg(widget->metaObject()->className(), widget->objectName());
    if (auto* const label = qobject_cast<QLabel*>(widget)) {
      label->ensurePolished();
      const bool rich = label->textFormat() == Qt::RichText || label->textFormat() == Qt::MarkdownText;
      if (label->textFormat() == Qt::AutoText || (rich && label->text().contains("<img")))
        found << place + label->text();
    }
    if (auto* const text = qobject_cast<QTextEdit*>(widget))
      if (text->toHtml().contains("pipe\"")) found << place + text->toHtml();
  }
  return found;
}

QLabel* toolTip() {
  for (QWidget* const widget : QApplication::topLevelWidgets())
    if (widget->inherits("QTipLabel") && widget->isVisible()) return qobject_cast<QLabel*>(widget);
  return nullptr;
}

void hover(QWidget& widget) {
  QHelpEvent event(QEvent::ToolTip, QPoint(1, 1), widget.mapToGlobal(QPoint(1, 1)));
  QApplication::sendEvent(&widget, &event);
}

}  // namespace

class TestPlainLabels : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }

  void labels_arePlain_unlessTheirFormatIsRich() {
    QWidget window;
    auto* const plain = new QLabel("<b>bold</b>", &window);
    auto* const rich = new QLabel("<b>bold</b>", &window);
    rich->setTextFormat(Qt::RichText);
    window.show();
    QCOMPARE(plain->textFormat(), Qt::PlainText);
    QCOMPARE(rich->textFormat(), Qt::RichText);
    QVERIFY(plain->sizeHint().width() > rich->sizeHint().width());
    QMessageBox box(QMessageBox::Information, "title", "<b>bold</b>");
    box.show();
    QCOMPARE(box.findChild<QLabel*>("qt_msgbox_label")->textFormat(), Qt::PlainText);
  }

  void toolTips_arePlain_exceptOwnOnes() {
    QWidget window;
    auto* const own = new QWidget(&window);
    auto* const other = new QWidget(&window);
    for (QWidget* const widget : {own, other}) {
      widget->setGeometry(widget == own ? 0 : 60, 0, 50, 50);
      widget->setToolTip("<b>bold</b>");
    }
    useRichToolTip(*own);
    window.show();
    for (int time = 0; time < 2; ++time) {  // the second time in the same label
      hover(*other);
      QVERIFY(toolTip() != nullptr);
      QCOMPARE(toolTip()->textFormat(), Qt::PlainText);
      hover(*own);
      QCOMPARE(toolTip()->textFormat(), Qt::RichText);
    }
    QToolTip::hideText();
  }

  void namesOfSensors_areShownAsText() {
    const QString pipe = scratch_.filePath("pipe");
    QCOMPARE(::mkfifo(qPrintable(pipe), 0600), 0);
    Session session = readSession(copyOfSimulatedSession(scratch_.path()).toStdString());
    const std::string name = "<img src=\"" + pipe.toStdString() + "\">";
    session.cameras.front().name = name + "camera";
    session.imus.front().name = session.reference = name + "imu";
    session.board_name = name + "board";
    const QString file = scratch_.filePath("hostile.yaml");
    QFile written(file);
    QVERIFY(written.open(QIODevice::WriteOnly));
    written.write(QByteArray::fromStdString(sessionYaml(session, scratch_.path().toStdString())));
    written.close();

    WindowFixture test;
    test.window.files().open(file);
    QTRY_VERIFY(test.document().hasSession());
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    for (const QString& page : test.window.screenNames()) {
      test.window.showScreen(page);
      spin(200);
    }
    const ExportDialog exporting(proposedExport(test.document().session()), &test.window);
    showPrintBoard(&test.window, test.window.workbench());
    const QStringList found = richTexts();
    QVERIFY2(found.isEmpty(), qPrintable(found.join('\n')));
    // The names are there at all, so that this test finds what it looks for.
    bool seen = false;
    for (const QLabel* const label : test.window.findChildren<QLabel*>())
      seen = seen || label->text().contains("<img");
    QVERIFY(seen);
    test.document().undoStack().setClean();
  }

  void numbers_areReadInOneWay_data() {
    QTest::addColumn<double>("value");  // not finite: refused
    const double none = std::nan("");
    QTest::newRow("0.5") << 0.5;
    QTest::newRow("0,5") << 0.5;
    QTest::newRow("0,125") << 0.125;
    QTest::newRow(" 1e3 ") << 1000.0;
    QTest::newRow("1,2345") << 1.2345;
    QTest::newRow("1,000") << none;
    QTest::newRow("1,300") << none;
    QTest::newRow("-12,345") << none;
    QTest::newRow("1,000,000") << none;
    QTest::newRow("1,000.5") << none;
    QTest::newRow("nan") << none;
    QTest::newRow("inf") << none;
    QTest::newRow("1e999") << none;
    QTest::newRow("0x10") << none;
  }
  void numbers_areReadInOneWay() {
    QFETCH(const double, value);
    const auto [typed, problem] = typedNumber(QTest::currentDataTag());
    QCOMPARE(typed.has_value(), std::isfinite(value));
    if (typed) QCOMPARE(*typed, value);
    QCOMPARE(problem.isEmpty(), typed.has_value());
    // The field keeps its number, and states why.
    NumberField field(-1e6, 1e6);
    field.setValue(7.0);
    field.show();
    type(&field, QTest::currentDataTag());
    QCOMPARE(field.value(), typed.value_or(7.0));
    QCOMPARE(field.hasRefused(), !typed);
  }

  // In a country with decimal commas.
  void boxes_haveADecimalPoint() {
    const auto restored = qScopeGuard([before = QLocale()] { QLocale::setDefault(before); });
    QLocale::setDefault(QLocale(QLocale::German, QLocale::Germany));
    DecimalBox box;
    box.setDecimals(3);
    box.setRange(0.0, 1e6);
    box.setSuffix(" s");
    box.setValue(2.5);
    QCOMPARE(box.text(), QString("2.500 s"));
    auto* const field = box.findChild<QLineEdit*>();
    box.show();
    field->selectAll();
    QTest::keyClicks(field, "1,25");
    QTest::keyClick(field, Qt::Key_Return);
    QCOMPARE(box.value(), 1.25);
    field->selectAll();
    field->insert("1,300");  // as if pasted
    QTest::keyClick(field, Qt::Key_Return);
    QCOMPARE(box.value(), 1.25);
  }
};

EVICAL_TEST(TestPlainLabels)
#include "tst_plain_labels.moc"
