// Files of strangers, and odd surroundings: names that operate the terminal, the shell or a spreadsheet, or
// that lead out of the output folder; full disks and missing folders.
#include "tests/support/test_program.h"
#include "tests/system/program.h"
#include "tests/system/session_case.h"

#include <QDir>
#include <QFileInfo>
#include <QProcess>
#include <QTemporaryDir>

using namespace evical::test;

namespace {

// The simulated bag with a topic of the same length that clears the screen.
QString bagWithEscapes(const QTemporaryDir& folder) {
  QByteArray bag = readFile(simulated("short_bag") + "/recording.bag");
  bag.replace("/davis_left/events", "/davis_left/ev\x1b[2J");
  writeFile(folder.filePath("escapes.bag"), bag);
  return folder.filePath("escapes.bag");
}

bool hasEscapes(const QString& text) {
  return text.contains('\x1b') || text.contains('\r') || text.contains('\a');
}

QByteArray withPath(const char* variable, const QString& path) {
  const QByteArray usual = qgetenv(variable);
  qputenv(variable, path.toUtf8());
  return usual;
}

}  // namespace

class TestHostileNames : public QObject {
  Q_OBJECT

 private slots:
  void topic_thatOperatesTheTerminal_isShownAndNotRead() {
    const QTemporaryDir folder;
    const QString bag = bagWithEscapes(folder);
    for (const QStringList& command : {QStringList{"inspect", bag}, QStringList{"inspect", "--json", bag},
                                       QStringList{"convert", bag, "-o", folder.filePath("copy.mcap")}}) {
      const Outcome outcome = runProgram(command);
      VERIFY_OUTCOME(outcome, 0);
      QVERIFY2(!hasEscapes(outcome.output + outcome.errors), qPrintable(outcome.output));
      QVERIFY2((outcome.output + outcome.errors).contains("/davis_left/ev\\x1b[2J") ||
                   outcome.output.contains("/davis_left/ev\\\\x1b[2J"),
               qPrintable(outcome.output + outcome.errors));
    }
    // The recording has no other events, so there is nothing to calibrate.
    const Outcome init = runProgram({"init", bag, "-o", folder.filePath("session.yaml")});
    VERIFY_OUTCOME(init, 2);
    QVERIFY2(!hasEscapes(init.output + init.errors), qPrintable(init.errors));
    QVERIFY(!QFile::exists(folder.filePath("session.yaml")));
  }

  void messages_showEscapes() {
    const Outcome outcome = runProgram({"inspect", "/none/\x1b]0;title\x07.bag"});
    VERIFY_OUTCOME(outcome, 2);
    QVERIFY2(!hasEscapes(outcome.errors), qPrintable(outcome.errors));
    VERIFY_TEXT(outcome.errors, R"(/none/\\x1b\]0;title\\x07\.bag)");
  }

  // A batch writes its script before it looks for sbatch.
  void slurmScript_hasNoLineOfAPath() {
    const QTemporaryDir folder;
    const QString jobs = folder.filePath("jobs.yaml"), output = folder.filePath("x\ntouch canary #");
    writeFile(jobs, "evical_batch: 1\njobs:\n  - {name: one, session: " +
                        (simulated("short_bag") + "/session.yaml").toUtf8() + "}\n");
    const QByteArray usual = withPath("PATH", folder.filePath("none"));
    const Outcome outcome = runProgram({"batch", jobs, "-o", output, "--slurm"});
    const Outcome quoted = runProgram({"batch", jobs, "-o", folder.filePath("a\"b $(c) 'd' %e"), "--slurm"});
    qputenv("PATH", usual);
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_TEXT(outcome.errors, R"(x\\x0atouch canary #.*Remove the character)");
    QVERIFY(!QFile::exists(output + "/slurm.sh"));
    VERIFY_OUTCOME(quoted, 1);
    const QByteArray script = readFile(folder.filePath("a\"b $(c) 'd' %e/slurm.sh"));
    QVERIFY2(script.contains("/a\\\"b $(c) 'd' %%e/jobs/slurm-%a.txt\"\n"), script);
  }

  // The names of cameras are those of folders.
  void cameras_whoseNamesLeadElsewhere_writeIntoTheOutput() {
    SessionCase test("second");
    const QString elsewhere = test.path("elsewhere");
    QDir().mkpath(test.path("out/images"));
    const QString session = QString::fromUtf8(readFile(test.session()));
    const QRegularExpression name("^cameras:\\n  (\\w+):", QRegularExpression::MultilineOption);
    const QString camera = name.match(session).captured(1);
    test.change("cameras:\n  " + camera + ":", "cameras:\n  \"../../elsewhere/" + camera + "\":");
    // A link in the output leads elsewhere, too.
    QDir().mkpath(elsewhere);
    QVERIFY(QFile::link(elsewhere, test.path("out/images/.._.._elsewhere_" + camera)));
    const Outcome outcome = runProgram({"detect", test.session(), "-o", test.path("out"), "--images"});
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY(filesIn(elsewhere).isEmpty());
    QCOMPARE(filesIn(test.path("out/images")), QStringList(".._.._elsewhere_" + camera));
    QVERIFY(!filesIn(test.path("out/images/.._.._elsewhere_" + camera)).isEmpty());
  }

  void detection_onAFullDisk_leavesNoFolder() {
    SessionCase test("short_bag");
    const Outcome outcome = runProgramWithFileLimit({"detect", test.session(), "-o", test.path("out")}, 4);
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_SAYS(outcome, "cannot be written: File too large");
    QVERIFY(!QFile::exists(test.path("out")));
  }

  void conversionToHdf5_onAFullDisk_namesTheReason() {
    const QTemporaryDir folder;
    const Outcome outcome = runProgramWithFileLimit(
        {"convert", simulated("short_bag") + "/recording.bag", "-o", folder.filePath("copy.h5")}, 64);
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_SAYS(outcome, "cannot be written: File too large\\. Check the folder");
    QVERIFY(filesIn(folder.path()).isEmpty());
  }

  // A folder that does not exist, and one that is full.
  void packedRecording_needsATemporaryFolder() {
    const QTemporaryDir folder;
    const QString bag = folder.filePath("copy.mcap"), packed = bag + ".zstd";
    VERIFY_OUTCOME(runProgram({"convert", simulated("short_bag") + "/recording.bag", "-o", bag}), 0);
    if (QProcess::execute("zstd", {"-q", bag, "-o", packed}) != 0) QSKIP("zstd is not installed");
    VERIFY_OUTCOME(runProgram({"inspect", packed}), 0);
    const Outcome full = runProgramWithFileLimit({"inspect", packed}, 64);
    VERIFY_OUTCOME(full, 1);
    VERIFY_SAYS(full, "cannot be unpacked into the temporary folder.*TMPDIR");
    const QByteArray usual = withPath("TMPDIR", folder.filePath("none"));
    const Outcome missing = runProgram({"inspect", packed});
    const bool was_set = !usual.isNull();
    was_set ? qputenv("TMPDIR", usual) : qunsetenv("TMPDIR");
    VERIFY_OUTCOME(missing, 2);
    VERIFY_SAYS(missing, "temporary folder.*Set TMPDIR");
  }

  void export_replacesLinksToFolders_andRefusesControlCharacters() {
    const QTemporaryDir folder;
    const QString result = folder.filePath("result.yaml"), elsewhere = folder.filePath("elsewhere");
    const QByteArray truth = readFile(simulated("short_bag") + "/truth.yaml");
    writeFile(result, truth);
    QDir().mkpath(elsewhere);
    QDir().mkpath(folder.filePath("out"));
    QVERIFY(QFile::link(elsewhere, folder.filePath("out/kalibr")));
    const QStringList command = {"export", result, "--to", "kalibr", "-o", folder.filePath("out"), "--check"};
    const Outcome outcome = runProgram(command);
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY(filesIn(elsewhere).isEmpty() && QFile::exists(folder.filePath("out/kalibr/imu.yaml")));
    writeFile(result, truth + "reason: \"ok\\rimport os\"\n");
    const Outcome hostile = runProgram(command);
    VERIFY_OUTCOME(hostile, 2);
    VERIFY_SAYS(hostile, R"(reason.*control character: 'ok\\x0dimport os')");
  }
};

EVICAL_TEST(TestHostileNames)
#include "tst_hostile_names.moc"
