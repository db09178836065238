// SPDX-License-Identifier: GPL-3.0-or-later
// Keys work for any focus that remains after mouse actions.
#include "core/optimisation/optimisation_options.h"
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/timeline.h"
#include "ui/forms/option_editor.h"
#include "ui/forms/option_form.h"
#include "ui/screens/recording/motion_picture.h"
#include "ui/window/session_files.h"
#include "ui/window/user_guide.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QScrollBar>
#include <QSet>
#include <QShortcut>
#include <QTextBlock>
#include <QTextBrowser>

#include <cmath>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

// Sends keys to the focused widget, like the keyboard.
void pressKey(Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QVERIFY(QApplication::focusWidget() != nullptr);
  QTest::keyClick(QApplication::focusWidget(), key, modifiers);
}

// A test of Detection's keys after another action of the user.
struct Opened : WindowFixture {
  explicit Opened(const QString& session) { window.files().open(session); }
  DetectionScreen& detection() { return *child<DetectionScreen>(); }
  void choosePage(const QString& title) {
    auto* const list = child<QListWidget>("navigation");
    const QListWidgetItem* const item = list->findItems(title, Qt::MatchExactly).front();
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualItemRect(item).center());
  }
  void keysOfDetectionWork() {
    DetectionScreen& screen = detection();
    QTRY_VERIFY_WITH_TIMEOUT(screen.timeline().end_s() > 3.0, kPatience_ms);
    screen.setTime(1.0);
    pressKey(Qt::Key_Right);
    const double after_s = screen.time_s();
    QVERIFY(after_s > 1.0);
    pressKey(Qt::Key_Left);
    QVERIFY(screen.time_s() < after_s);
    pressKey(Qt::Key_End);
    QCOMPARE(screen.time_s(), screen.timeline().end_s());
    pressKey(Qt::Key_Home);
    QCOMPARE(screen.time_s(), screen.timeline().begin_s());
    pressKey(Qt::Key_Space);
    QVERIFY(screen.isPlaying());
    pressKey(Qt::Key_Space);
    QVERIFY(!screen.isPlaying());
  }
};

}  // namespace

class TestMainWindowKeys : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }

  void detection_hasItsKeys_afterThePageWasChosenByMouse_orALayerClicked() {
    Opened test(copyOfSimulatedSession(scratch_.path()));
    test.choosePage("Detection");
    QCOMPARE(test.screen(), QString("detection"));
    test.keysOfDetectionWork();
    auto* const layer = test.detection().findChild<QCheckBox*>();
    const bool shown = layer->isChecked();
    QTest::mouseClick(layer, Qt::LeftButton, {}, QPoint(8, layer->height() / 2));
    QCOMPARE(layer->isChecked(), !shown);
    test.keysOfDetectionWork();
    QCOMPARE(layer->isChecked(), !shown);
  }

  void detection_hasItsKeys_whileTheListOfPagesHasTheFocus() {
    Opened test(copyOfSimulatedSession(scratch_.path()));
    test.window.showScreen("detection");
    test.child<QListWidget>("navigation")->setFocus();
    test.keysOfDetectionWork();
  }

  void space_pressesTheButtonThatWasReachedByTab() {
    Opened test(copyOfSimulatedSession(scratch_.path()));
    test.window.showScreen("detection");
    auto* const layer = test.detection().findChild<QCheckBox*>();
    const bool shown = layer->isChecked();
    layer->setFocus(Qt::TabFocusReason);
    pressKey(Qt::Key_Space);
    QCOMPARE(layer->isChecked(), !shown);
    QVERIFY(!test.detection().isPlaying());
  }

  void undo_takesAnOptionBack_whileItsFieldHasTheFocus() {
    Opened test(copyOfSimulatedSession(scratch_.path()));
    test.press(Qt::Key_P, Qt::ControlModifier);
    auto* const field =
        test.child<OptionForm>()->editor("optimisation.verdict.needed_rotation_deg")->findChild<QLineEdit*>();
    const QString before = field->text();
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, "0.07");
    pressKey(Qt::Key_Z, Qt::ControlModifier);  // what is being typed
    QCOMPARE(field->text(), before);
    QVERIFY(!test.document().undoStack().canUndo());
    field->selectAll();
    QTest::keyClicks(field, "0.07");
    QTest::keyClick(field, Qt::Key_Return);
    QCOMPARE(test.document().session().options.optimisation->needed_rotation_deg, 0.07);
    QVERIFY(field->hasFocus());
    pressKey(Qt::Key_Z, Qt::ControlModifier);
    QCOMPARE(field->text(), before);
    QVERIFY(!test.document().undoStack().canUndo());
    pressKey(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    QCOMPARE(test.document().session().options.optimisation->needed_rotation_deg, 0.07);
    QCOMPARE(field->text(), QString("0.07"));
  }

  // The page of keys is a part of the guide, which is written by hand.
  void everyShortcut_isOnThePageOfKeys() {
    WindowFixture test;
    pressKey(Qt::Key_Question);
    auto* const page = test.child<QDialog>("keys");
    QVERIFY(page && page->isVisible());
    const QString text = page->findChild<QTextBrowser*>()->toPlainText();
    int shortcuts = 0;
    for (const QAction* const action : test.window.findChildren<QAction*>()) {
      if (action->shortcut().isEmpty() || action->text().isEmpty()) continue;
      const QString key = action->shortcut().toString();
      const bool screen = key.size() == 6 && key.startsWith("Ctrl+") && key[5].isDigit();
      QVERIFY2(text.contains(screen ? QString("Ctrl+1 ... Ctrl+9, Ctrl+0") : key),
               qPrintable(action->text() + key));
      ++shortcuts;
    }
    QVERIFY(shortcuts > 15);
    int of_pages = 0;
    for (const QShortcut* const shortcut : test.window.findChildren<QShortcut*>()) {
      const QString key = shortcut->key().toString();
      QVERIFY2(text.contains(key), qPrintable(key));
      ++of_pages;
    }
    QVERIFY(of_pages >= 11);
  }

  // Every page and every motion is present, and is shown in its section.
  void guide_hasPictures() {
    WindowFixture test;
    test.press(Qt::Key_F1);
    auto* const browser = test.child<QDialog>("user_guide")->findChild<QTextBrowser*>();
    QTRY_VERIFY(browser->verticalScrollBar()->maximum() > 1000);
    QTRY_COMPARE(browser->verticalScrollBar()->value(), 0);  // it opens at the top
    QStringList shown;
    for (QTextBlock block = browser->document()->begin(); block.isValid(); block = block.next())
      for (auto part = block.begin(); !part.atEnd(); ++part)
        if (const QTextImageFormat image = part.fragment().charFormat().toImageFormat(); image.isValid())
          shown << image.name();
    QCOMPARE(shown.size(), guidePictures().size() + static_cast<qsizetype>(shownMotions().size()));
    for (const QString& name : shown) {
      const QImage image = browser->document()->resource(QTextDocument::ImageResource, name).value<QImage>();
      QVERIFY2(image.width() > 300 && image.height() > 150, qPrintable(name));
      QSet<QRgb> colours;
      for (int y = 0; y < image.height(); y += 3)
        for (int x = 0; x < image.width(); x += 3) colours << image.pixel(x, y);
      QVERIFY2(colours.size() > 8, qPrintable(name));
    }
    for (const QString& page : test.window.screenNames().mid(0, 8))  // those with the data of one recording
      QVERIFY2(shown.filter(page == "result" ? "result-light" : page).size() >= 1, qPrintable(page));
  }

  void guide_hasContents_thatLeadToItsParts() {
    WindowFixture test;
    test.press(Qt::Key_F1);
    auto* const guide = test.child<QDialog>("user_guide");
    QVERIFY(guide && guide->isVisible());
    auto* const contents = guide->findChild<QListWidget*>("contents");
    auto* const browser = guide->findChild<QTextBrowser*>();
    QVERIFY(contents->count() >= 6);
    QVERIFY(contents->item(0)->font().bold() &&
            !contents->findItems("Print a board", Qt::MatchExactly).value(0)->font().bold());
    QVERIFY(!browser->toPlainText().contains("](") &&
            !browser->toHtml().contains("href"));             // no links to other pages
    QCOMPARE(contents->horizontalScrollBar()->maximum(), 0);  // long headings end with dots
    QCOMPARE(contents->item(2)->toolTip(), contents->item(2)->text());
    contents->setCurrentRow(3);
    const QString top = browser->cursorForPosition({30, 8}).block().text();
    QCOMPARE(top, contents->item(3)->text());
  }

  void guide_canBeSearched() {
    WindowFixture test;
    test.press(Qt::Key_F1);
    auto* const guide = test.child<QDialog>("user_guide");
    QVERIFY(guide && guide->isVisible());
    guide->activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(guide));
    auto* const key = guide->findChild<QShortcut*>();
    QCOMPARE(key->key(), QKeySequence(QKeySequence::Find));
    emit key->activated();
    auto* const field = guide->findChild<QLineEdit*>("guide_search");
    auto* const matches = guide->findChild<QLabel*>("guide_matches");
    auto* const browser = guide->findChild<QTextBrowser*>();
    QTRY_VERIFY(field->hasFocus());
    QTest::keyClicks(field, "noise densities");
    QCOMPARE(browser->textCursor().selectedText().toLower(), QString("noise densities"));
    QVERIFY(matches->text().contains("match"));
    const int first = browser->textCursor().selectionStart();
    field->clear();
    QTest::keyClicks(field, "the");
    const int second = browser->textCursor().selectionStart();
    QTest::keyClick(field, Qt::Key_Return);
    QVERIFY(guide->isVisible());  // Return does not close the dialog
    QVERIFY(browser->textCursor().selectionStart() > second);
    QVERIFY(second >= first);
    field->clear();
    QTest::keyClicks(field, "no such words");
    QCOMPARE(matches->text(), QString("0 matches"));
  }
};

EVICAL_TEST(TestMainWindowKeys)
#include "tst_main_window_keys.moc"
