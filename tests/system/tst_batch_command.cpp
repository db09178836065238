// `evical batch`: a separate process and failure per job, a table with the reasons, continuation of stopped
// batches, and invalid job files. tests/cluster tests it on a cluster.
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <csignal>

using namespace evical::test;

namespace {

constexpr const char* kShort = "{time_range_s: '[0, 5]'}";

}  // namespace

class TestBatchCommand : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  QString path(const QString& name) const { return folder_.filePath(name); }
  static QString session(const QString& recording) { return simulated(recording) + "/session.yaml"; }

  QString writeJobs(const QString& name, const QString& text) const {
    writeFile(path(name), ("evical_batch: 1\n" + text).toUtf8());
    return path(name);
  }
  QString endOf(const QString& folder, const QString& job) const {
    const QString text = QString::fromUtf8(readFile(path(folder + "/jobs/" + job + ".yaml")));
    return QRegularExpression("^end: (\\w+)$", QRegularExpression::MultilineOption).match(text).captured(1);
  }
  QDateTime resultTime(const QString& folder, const QString& job) const {
    return QFileInfo(path(folder + "/" + job + "/result.yaml")).lastModified();
  }

 private slots:
  void ignoredChildSignals_hideNoFailure() {
    const QString jobs = writeJobs(
        "ignored.yaml",
        QString("jobs:\n  - {name: gone, session: %1, recording: nowhere.bag}\n").arg(session("short_bag")));
    const Outcome outcome = runProgramWithoutChildSignals({"batch", jobs, "-o", path("ignored")});
    VERIFY_OUTCOME(outcome, 1);
    QCOMPARE(endOf("ignored", "gone"), "bad_input");
  }

  void failures_takeNoOtherWithThem_andAreTold() {
    const QString jobs = writeJobs(
        "mixed.yaml", QString("set: %1\nat_once: 2\njobs:\n  - {name: good, session: %2}\n"
                              "  - {name: too_short, session: %2, set: {time_range_s: '[0, 0.2]'}}\n"
                              "  - {name: gone, session: %2, recording: nowhere.bag}\n"
                              "  - {name: other, session: %3}\n")
                          .arg(kShort, session("short_bag"), session("second")));
    const Outcome outcome = runProgram({"batch", jobs, "-o", path("mixed")});
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_TEXT(outcome.output, "2 of 4 have no result:");
    VERIFY_TEXT(outcome.output, "too_short: .*too short");
    VERIFY_TEXT(outcome.output, "gone: .*nowhere.bag: does not exist");
    QCOMPARE(endOf("mixed", "good"), "done");
    QCOMPARE(endOf("mixed", "other"), "done");
    QCOMPARE(endOf("mixed", "too_short"), "failed");
    QCOMPARE(endOf("mixed", "gone"), "bad_input");
    const QString yaml = QString::fromUtf8(readFile(path("mixed/batch.yaml")));
    QVERIFY2(yaml.startsWith("evical_batch: 1\nstatus: failed\nreason: \"2 of 4 jobs have no result\"\n"),
             qPrintable(yaml));
    const QStringList lines =
        QString::fromUtf8(readFile(path("mixed/batch.csv"))).split('\n', Qt::SkipEmptyParts);
    QCOMPARE(lines.size(), 5);
    VERIFY_TEXT(lines[0], "^name,status,reason,left.rotation");
    VERIFY_TEXT(lines[1], "^good,(ok|doubtful),");
    VERIFY_TEXT(lines[2], "^too_short,failed,");
  }

  // Finished jobs are not repeated; failed ones, whose cause may have been fixed, are tried again.
  void secondRun_doesOnlyWhatIsLeft() {
    const QDateTime before = resultTime("mixed", "good");
    const Outcome again = runProgram({"batch", path("mixed.yaml"), "-o", path("mixed")});
    VERIFY_OUTCOME(again, 1);
    QCOMPARE(resultTime("mixed", "good"), before);
    VERIFY_TEXT(again.errors, "good: done, in an earlier run");
    VERIFY_TEXT(again.errors, "too_short: .*in an earlier run");
    QVERIFY2(!again.errors.contains(QRegularExpression("gone: .*in an earlier run")),
             qPrintable(again.errors));
    QVERIFY(QFile::copy(simulated("short_bag") + "/recording.bag", path("nowhere.bag")));
    const Outcome mended = runProgram({"batch", path("mixed.yaml"), "-o", path("mixed")});
    VERIFY_OUTCOME(mended, 1);
    VERIFY_TEXT(mended.output, "1 of 4 have no result:");
    QCOMPARE(endOf("mixed", "gone"), "done");
    QCOMPARE(resultTime("mixed", "good"), before);
  }

  void changedOptions_runAgain() {
    const QString text = QString::fromUtf8(readFile(path("mixed.yaml")));
    writeFile(path("mixed.yaml"), QString(text).replace("[0, 5]", "[0, 4.5]").toUtf8());
    const QDateTime before = resultTime("mixed", "good");
    VERIFY_OUTCOME(runProgram({"batch", path("mixed.yaml"), "-o", path("mixed"), "--job", "good"}), 0);
    QVERIFY(resultTime("mixed", "good") > before);
    const Outcome table = runProgram({"batch", path("mixed.yaml"), "-o", path("mixed"), "--collect"});
    VERIFY_OUTCOME(table, 1);  // the others have other options
    VERIFY_TEXT(table.output, "other: was not run");
    QVERIFY2(!table.output.contains("good: "), qPrintable(table.output));
  }

  void allDone_endsWith0() {
    const QString jobs = writeJobs(
        "fine.yaml", QString("session: %1\nset: %2\njobs:\n  - %3\n")
                         .arg(session("short_bag"), kShort, simulated("short_bag") + "/recording.bag"));
    const Outcome outcome = runProgram({"batch", jobs, "-o", path("fine"), "--jobs", "1", "--quiet"});
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY(outcome.errors.isEmpty());
    QVERIFY(readFile(path("fine/batch.yaml")).startsWith("evical_batch: 1\nstatus: ok\nreason: \"\"\n"));
    QVERIFY(QFile::exists(path("fine/recording/report.html")));
  }

  void memoryLimit_isItsOwnJobs() {
    const QString jobs =
        writeJobs("small.yaml", QString("set: %1\nmemory_limit_mb: 60\njobs:\n  - {name: one, session: %2}\n")
                                    .arg(kShort, session("short_bag")));
    const Outcome outcome = runProgram({"batch", jobs, "-o", path("small")});
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_TEXT(outcome.output, "one: needs more memory than the limit of 60 MB");
    QCOMPARE(endOf("small", "one"), "out_of_memory");
    QVERIFY(!QFile::exists(path("small/one/result.yaml")));
  }

  void interrupted_goesOnLater() {
    const QString jobs = writeJobs(
        "cut.yaml",
        QString("set: %1\nat_once: 1\njobs:\n  - {name: one, session: %2}\n  - {name: two, session: %2}\n")
            .arg(kShort, session("short_bag")));
    const Outcome outcome =
        interruptProgram({"batch", jobs, "-o", path("cut")}, SIGINT,
                         [](const QString& errors) { return errors.contains("two: started"); });
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_TEXT(outcome.reason(), "cancelled");
    QCOMPARE(endOf("cut", "one"), "done");
    QCOMPARE(endOf("cut", "two"), "cancelled");
    const QDateTime before = resultTime("cut", "one");
    VERIFY_OUTCOME(runProgram({"batch", jobs, "-o", path("cut")}), 0);
    QCOMPARE(resultTime("cut", "one"), before);
    QCOMPARE(endOf("cut", "two"), "done");
  }

  void badJobs_endWith2_data() {
    QTest::addColumn<QString>("text");
    QTest::addColumn<QString>("part");
    const QString own = session("short_bag");
    QTest::newRow("no jobs") << "jobs: []\n"
                             << "jobs.*is empty";
    QTest::newRow("no list") << "threads: 1\n"
                             << "jobs.*is missing";
    QTest::newRow("unknown key") << "job: [a.yaml]\njobs: [" + own + "]\n"
                                 << "job.*unknown key|no such key|unknown";
    QTest::newRow("no session") << "jobs: [a.bag]\n"
                                << "no session describes it";
    QTest::newRow("nothing to run") << "session: a.yaml\njobs: [{name: x}]\n"
                                    << "neither a recording nor a session";
    QTest::newRow("two names") << "jobs: [{name: x, session: " + own + "}, {name: x, session: " + own + "}]\n"
                               << "two jobs have the name 'x'";
    QTest::newRow("name out of the folder") << "jobs: [{name: ../x, session: " + own + "}]\n"
                                            << "valid name for a result folder";
    QTest::newRow("no memory") << "memory_limit_mb: 0\njobs: [" + own + "]\n"
                               << "memory_limit_mb";
  }
  void badJobs_endWith2() {
    QFETCH(QString, text);
    QFETCH(QString, part);
    const Outcome outcome = runProgram({"batch", writeJobs("bad.yaml", text), "-o", path("bad")});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_TEXT(outcome.reason(), part);
    QVERIFY(!QDir(path("bad")).exists());
  }

  void wrongPlaces_endWith2() {
    const QString jobs = path("fine.yaml");
    VERIFY_OUTCOME(runProgram({"batch", path("nowhere.yaml"), "-o", path("bad")}), 2);
    const Outcome unknown = runProgram({"batch", jobs, "-o", path("fine"), "--job", "recordin"});
    VERIFY_OUTCOME(unknown, 2);
    VERIFY_TEXT(unknown.errors, "has no job 'recordin'.*recording");
    VERIFY_OUTCOME(runProgram({"batch", jobs, "-o", path("empty"), "--collect"}), 2);
    const Outcome result = runProgram({"batch", jobs, "-o", path("fine/recording")});
    VERIFY_OUTCOME(result, 2);
    VERIFY_TEXT(result.reason(), "contains the result of a calibration");
    writeFile(path("file"), "a file");
    VERIFY_OUTCOME(runProgram({"batch", jobs, "-o", path("file")}), 2);
  }

  // The path has no program of Slurm's, even if the machine has them.
  void withoutSlurm_saysSo_andKeepsTheScript() {
    const QString jobs = writeJobs(
        "queue.yaml", QString("threads: 2\nmemory_limit_mb: 700\njobs:\n  - {name: one, session: %1}\n")
                          .arg(session("short_bag")));
    const QByteArray usual = qgetenv("PATH");
    qputenv("PATH", path("none").toUtf8());
    const Outcome outcome =
        runProgram({"batch", jobs, "-o", path("queue"), "--slurm", "--slurm-options", "--time=5"});
    qputenv("PATH", usual);
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_TEXT(outcome.errors, "sbatch");
    const QString script = QString::fromUtf8(readFile(path("queue/slurm.sh")));
    for (const char* const line :
         {"#SBATCH --array=0-0", "#SBATCH --cpus-per-task=2", "#SBATCH --mem=700M", "jobs=(one)"})
      QVERIFY2(script.contains(line), qPrintable(script));
  }
};

EVICAL_TEST(TestBatchCommand)
#include "tst_batch_command.moc"
