#include "core/base/plain_text.h"
#include "tests/support/test_program.h"

#include <QProcess>

using namespace evical;

class TestShellWord : public QObject {
  Q_OBJECT
 private slots:
  void plainText_staysAsItIs() {
    QCOMPARE(shellWord("optimisation.model.board_bow=true"),
             std::string("optimisation.model.board_bow=true"));
    QCOMPARE(shellWord("/data/session-2.yaml"), std::string("/data/session-2.yaml"));
  }
  void shell_readsBackEveryText_data() {
    QTest::addColumn<QString>("text");
    for (const char* text : {"my session.yaml", "it's", "$HOME", "time_range_s=[1,2]", "a;b&c|d", "*?", "",
                             "~", "\"quoted\"", "back\\slash", "`ls`", "a\tb"})
      QTest::newRow(text) << text;
  }
  void shell_readsBackEveryText() {
    QFETCH(QString, text);
    QProcess shell;
    shell.start("/bin/sh", {"-c", "printf %s " + QString::fromStdString(shellWord(text.toStdString()))});
    QVERIFY(shell.waitForFinished());
    QCOMPARE(QString::fromUtf8(shell.readAllStandardOutput()), text);
  }
};

EVICAL_TEST(TestShellWord)
#include "tst_shell_word.moc"
