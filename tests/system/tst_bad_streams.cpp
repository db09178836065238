// Standard streams that are closed or full, paths that are not files, and folders that cannot be created.
#include "tests/system/session_case.h"

#include <sys/stat.h>

#include <QElapsedTimer>

#include <csignal>

using namespace evical::test;

class TestBadStreams : public QObject {
  Q_OBJECT

 private slots:
  void errors_thatNobodyReceives_costNothing_data();
  void errors_thatNobodyReceives_costNothing();
  void output_thatNobodyReceives_isAnError_data();
  void output_thatNobodyReceives_isAnError();
  void closedStreams_areNotTheNextFiles();
  void sessions_thatAreNoFiles_areRefused_data();
  void sessions_thatAreNoFiles_areRefused();
  void recording_ofPipes_isRefused();
  void folder_thatCannotBeReached_isBadInput();
  void simulate_thatCannotFinish_leavesTheOldRecording();
  void export_thatIsInterrupted_leavesNothingHalf();
};

void TestBadStreams::errors_thatNobodyReceives_costNothing_data() {
  QTest::addColumn<QString>("redirection");
  QTest::newRow("closed") << "2>&-";
  QTest::newRow("full") << "2>/dev/full";
  QTest::newRow("all closed") << "<&- >&- 2>&-";
}

void TestBadStreams::errors_thatNobodyReceives_costNothing() {
  QFETCH(QString, redirection);
  VERIFY_OUTCOME(runProgramRedirected(redirection, {"calibrate", "nowhere.yaml", "-o", "x"}), 2);
  VERIFY_OUTCOME(runProgramRedirected(redirection, {"inspect", "nowhere.bag"}), 2);
  VERIFY_OUTCOME(runProgramRedirected(redirection, {"calibrat"}), 2);
}

void TestBadStreams::output_thatNobodyReceives_isAnError_data() {
  QTest::addColumn<QString>("redirection");
  QTest::newRow("closed") << ">&-";
  QTest::newRow("full") << ">/dev/full";
}

void TestBadStreams::output_thatNobodyReceives_isAnError() {
  QFETCH(QString, redirection);
  const QString recording = simulated("short_bag") + "/recording.bag",
                truth = simulated("short_bag") + "/truth.yaml";
  for (const QStringList& arguments :
       {QStringList{"options"}, QStringList{"inspect", "--json", recording},
        QStringList{"compare", truth, truth}, QStringList{"--help"}, QStringList{"--version"}}) {
    const Outcome outcome = runProgramRedirected(redirection, arguments);
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_SAYS(outcome, "standard output cannot be written");
  }
}

// A file opened with a closed stream's descriptor would receive the printed text.
void TestBadStreams::closedStreams_areNotTheNextFiles() {
  QTemporaryDir folder;
  const QString usual = folder.filePath("usual.svg"), closed = folder.filePath("closed.svg");
  VERIFY_OUTCOME(runProgram({"board", "-o", usual}), 0);
  VERIFY_OUTCOME(runProgramRedirected("<&- >&- 2>&-", {"board", "-o", closed}), 1);  // it prints, too
  QCOMPARE(readFile(closed), readFile(usual));
}

void TestBadStreams::sessions_thatAreNoFiles_areRefused_data() {
  QTest::addColumn<QString>("make");
  QTest::addColumn<QString>("says");
  QTest::newRow("pipe") << "mkfifo it"
                        << "pipe";
  QTest::newRow("device") << "ln -s /dev/zero it"
                          << "device";
  QTest::newRow("gigabytes") << "truncate -s 3G it"
                             << "3072 MB";
}

void TestBadStreams::sessions_thatAreNoFiles_areRefused() {
  QFETCH(QString, make);
  QFETCH(QString, says);
  QTemporaryDir folder;
  QProcess::execute("bash", {"-c", QStringLiteral("cd '%1' && %2").arg(folder.path(), make)});
  QElapsedTimer timer;
  timer.start();
  for (const QString command : {"calibrate", "detect", "simulate"}) {
    const Outcome outcome = runProgram({command, folder.filePath("it"), "-o", folder.filePath("out")}, 20);
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, says);
  }
  QVERIFY2(timer.elapsed() < 10'000, qPrintable(QString::number(timer.elapsed())));
}

void TestBadStreams::recording_ofPipes_isRefused() {
  QTemporaryDir folder;
  QCOMPARE(::mkfifo(qPrintable(folder.filePath("events.txt")), 0600), 0);
  const Outcome outcome = runProgram({"inspect", folder.path()}, 20);
  VERIFY_OUTCOME(outcome, 2);
  VERIFY_SAYS(outcome, "events.txt.*read twice");
}

// A link to itself has no status, like a folder without permission.
void TestBadStreams::folder_thatCannotBeReached_isBadInput() {
  QTemporaryDir folder;
  const QString loop = folder.filePath("loop");
  QVERIFY(QFile::link(loop, loop));
  SessionCase test;
  for (const QStringList& arguments :
       {QStringList{"calibrate", test.session(), "-o", loop + "/x"}, QStringList{"inspect", loop + "/x"},
        QStringList{"calibrate", loop + "/session.yaml", "-o", folder.filePath("x")},
        QStringList{"export", simulated("short") + "/truth.yaml", "--to", "kalibr", "-o", loop + "/x"},
        QStringList{"convert", loop + "/x", "-o", folder.filePath("x.bag")}}) {
    const Outcome outcome = runProgram(arguments);
    VERIFY_OUTCOME(outcome, 2);
    QVERIFY2(!outcome.errors.contains("internal error"), qPrintable(outcome.errors));
  }
}

void TestBadStreams::simulate_thatCannotFinish_leavesTheOldRecording() {
  QTemporaryDir folder;
  writeFile(folder.filePath("tiny.yaml"),
            "base: " + inSources("tests/system/short_bag.yaml").toUtf8() + "\nduration_s: 0.2\n");
  const QString made = folder.filePath("made");
  VERIFY_OUTCOME(runProgram({"simulate", folder.filePath("tiny.yaml"), "-o", made}), 0);
  const QByteArray recording = readFile(made + "/recording.bag"), truth = readFile(made + "/truth.yaml");
  QVERIFY(QFile::remove(made + "/session.yaml"));
  QVERIFY(QDir(made).mkdir("session.yaml"));  // cannot be replaced by a file
  writeFile(folder.filePath("other.yaml"), "base: tiny.yaml\nseed: 9\n");
  VERIFY_OUTCOME(runProgram({"simulate", folder.filePath("other.yaml"), "-o", made}), 1);
  QVERIFY(readFile(made + "/recording.bag") == recording);
  QCOMPARE(readFile(made + "/truth.yaml"), truth);
  QCOMPARE(filesIn(made), (QStringList{"recording.bag", "session.yaml", "truth.yaml"}));
}

void TestBadStreams::export_thatIsInterrupted_leavesNothingHalf() {
  QTemporaryDir folder;
  const QStringList targets = {"kalibr", "openvins", "basalt"};
  const auto command = [&](const QString& out) {
    return QStringList{"export", simulated("short") + "/truth.yaml", "--to", targets.join(','), "-o", out};
  };
  const QString whole = folder.filePath("whole");
  VERIFY_OUTCOME(runProgram(command(whole)), 0);
  for (int pause_ms = 0; pause_ms < 60; pause_ms += 6) {
    const QString out = folder.filePath(QString::number(pause_ms));
    QElapsedTimer timer;
    timer.start();
    interruptProgram(command(out), SIGTERM, [&](const QString&) { return timer.elapsed() >= pause_ms; });
    for (const QString& target : targets)
      if (!filesIn(out + "/" + target).isEmpty())
        QCOMPARE(filesIn(out + "/" + target), filesIn(whole + "/" + target));
  }
}

EVICAL_TEST(TestBadStreams)
#include "tst_bad_streams.moc"
