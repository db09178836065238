// SPDX-License-Identifier: GPL-3.0-or-later
// No page clips a text or paints over one, at any usual size. Also run at twice the scale.
#include "tests/support/test_program.h"
#include "tests/ui/clipped_text.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/theme/theme.h"
#include "ui/window/session_files.h"

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

class TestClippedText : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  // Every page in turn; also saves its picture if a folder is given.
  QStringList clippedIn(WindowFixture& test, QSize size, const QString& story) {
    QStringList found;
    test.window.resize(size);
    for (const QString& page : test.window.screenNames()) {
      test.window.showScreen(page);
      spin(150);
      const QString place = QString("%1, %2, %3x%4: ").arg(story, page).arg(size.width()).arg(size.height());
      for (const QString& text : clippedTexts(test.window)) found << place + text;
      const QString pictures = qEnvironmentVariable("EVICAL_PICTURES");
      if (!pictures.isEmpty())
        test.window.grab().save(QString("%1/%2-%3-%4.png")
                                    .arg(pictures, story.simplified().replace(' ', '_'), page)
                                    .arg(size.width()));
    }
    return found;
  }
  QStringList clippedAtAllSizes(WindowFixture& test, const QString& story) {
    QStringList found;
    for (const QSize size : {QSize(1024, 700), QSize(1280, 800), QSize(1920, 1080)})
      found << clippedIn(test, size, story);
    return found;
  }

 private slots:
  void initTestCase() { usePrivateFolders(scratch_); }
  void init() { QSettings().clear(); }
  void cleanup() { applyTheme(*qApp, Appearance::Light); }

  void helper_findsWhatIsCut() {
    QWidget parent;
    auto* const label = new QLabel("A text that is too long for this", &parent);
    label->setGeometry(0, 0, 50, 20);
    auto* const over = new QLabel("Over it", &parent);
    over->setGeometry(20, 0, 100, 40);
    parent.resize(300, 60);
    parent.show();
    QCOMPARE(clippedTexts(parent).size(), 2);
    label->setGeometry(0, 0, label->sizeHint().width(), label->sizeHint().height());
    over->move(0, label->height());
    QVERIFY2(clippedTexts(parent).isEmpty(), qPrintable(clippedTexts(parent).join('\n')));
    parent.resize(100, 60);
    QCOMPARE(clippedTexts(parent).size(), 1);
  }

  void pagesWithoutARecording() {
    WindowFixture test;
    const QStringList found = clippedAtAllSizes(test, "nothing open");
    QVERIFY2(found.isEmpty(), qPrintable(found.join('\n')));
  }

  void pages_data() {
    QTest::addColumn<Appearance>("appearance");
    QTest::newRow("light") << Appearance::Light;
    QTest::newRow("dark") << Appearance::Dark;
  }
  void pages() {
    QFETCH(Appearance, appearance);
    applyTheme(*qApp, appearance);
    WindowFixture test;
    test.window.files().open(copyOfSimulatedSession(scratch_.path()));
    QStringList found = clippedAtAllSizes(test, "opened");
    test.press(Qt::Key_F5);
    QCOMPARE(test.waitForJob(), JobOutcome::Done);
    spin(1000);  // pages are filled after the end
    found << clippedAtAllSizes(test, "calibrated");
    QVERIFY2(found.isEmpty(), qPrintable(found.join('\n')));
    QVERIFY(test.window.close());
  }
};

EVICAL_TEST(TestClippedText)
#include "tst_clipped_text.moc"
