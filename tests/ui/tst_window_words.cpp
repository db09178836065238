// SPDX-License-Identifier: GPL-3.0-or-later
// The window replaces pieces of core's messages. Each piece must still be in core, or the window would show commands.
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"
#include "ui/jobs/window_words.h"

#include <QDirIterator>
#include <QFile>
#include <QRegularExpression>

using namespace evical;

class TestWindowWords : public QObject {
  Q_OBJECT

  // The string literals of core's sources; neighbours are joined.
  static QString literalsOfCore() {
    const QString core = QString::fromStdString(evical::test::sourcePath("core"));
    const QRegularExpression between("\"\\s*\n\\s*\""), literal("\"(?:[^\"\\\\\n]|\\\\.)*\"");
    QString all;
    QDirIterator files(core, {"*.cpp"}, QDir::Files, QDirIterator::Subdirectories);
    while (files.hasNext()) {
      QFile file(files.next());
      if (!file.open(QIODevice::ReadOnly)) qFatal("%s cannot be read", qPrintable(file.fileName()));
      const QString text = QString::fromUtf8(file.readAll()).replace(between, "");
      for (QRegularExpressionMatchIterator found = literal.globalMatch(text); found.hasNext();)
        all += found.next().captured() + '\n';
    }
    return all;
  }

 private slots:
  void everyPiece_isSaidByCore() {
    const QString core = literalsOfCore();
    QVERIFY(core.size() > 200'000);
    for (const QString& piece : ui::piecesOfCoresMessages())
      QVERIFY2(core.contains(piece), qPrintable(piece));
  }

  void messages_speakOfPages() {
    QCOMPARE(ui::inWindowWords("Check the recording with 'evical inspect'"),
             QString("Look at its streams on the Recording page"));
  }
};

EVICAL_TEST(TestWindowWords)
#include "tst_window_words.moc"
