// `evical repeat`: verdicts as exit codes, JSON alone on stdout, files that other commands read, and invalid
// input.
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QDir>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <csignal>

using namespace evical::test;

class TestRepeatCommand : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  QString path(const QString& name) const { return folder_.filePath(name); }
  QString session(const QString& name) const { return path(name + ".yaml"); }

  // A part of the short recording, as a separate recording.
  void writeSession(const QString& name, const QString& from_to, const QString& change = {},
                    const QString& to = {}) {
    QString text = QString::fromUtf8(readFile(simulated("short") + "/session.yaml"));
    text.replace("recording: \".\"", "recording: " + simulated("short") + "\ntime_range_s: " + from_to);
    if (!change.isEmpty()) {
      QVERIFY2(text.contains(change), qPrintable(text));
      text.replace(change, to);
    }
    writeFile(session(name), text.toUtf8());
  }

 private slots:
  void initTestCase() {
    writeSession("first", "[0, 6]");
    writeFile(session("second"),
              QString::fromUtf8(readFile(simulated("second") + "/session.yaml"))
                  .replace("recording: recording.bag", "recording: " + simulated("second") + "/recording.bag")
                  .toUtf8());
    writeSession("early", "[0, 5.9]");
    writeSession("late", "[5.9, 6]");
    writeSession("overlapping", "[1, 6]");
    writeSession("other_board", "[0, 6]", "rows: 11", "rows: 9");
    writeSession("other_rig", "[0, 6]", "  left:", "  right:");
    writeSession("no_file", "[0, 6]", "recording: ", "recording: gone_");
    writeSession("list", "[0, 6]", "recording: " + simulated("short"),
                 "recordings: [" + simulated("short") + ", nowhere.bag]");
    writeSession("copies", "[0, 6]", "recording: " + simulated("short"),
                 "recordings: [" + simulated("short") + ", " + simulated("short") + "]");
    writeSession("one_listed", "[0, 6]", "recording: " + simulated("short"),
                 "recordings: [" + simulated("short") + "]");
    writeSession("formats", "[0, 6]", "recording: " + simulated("short"),
                 "recordings: [" + simulated("short") + ", " + simulated("short") + "/../short]");
  }

  void agreement_endsWith0_andOtherCommandsReadTheResult() {
    const Outcome outcome =
        runProgram({"repeat", session("first"), session("second"), "-o", path("both"), "--quiet"});
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY2(outcome.output.contains("unchanged: 2 recordings agree"), qPrintable(outcome.output));
    QVERIFY2(outcome.output.contains(QRegularExpression(
                 "left.translation.x \\[mm\\] +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9.]+ \\+- [0-9.]+\n")),
             qPrintable(outcome.output));
    QCOMPARE(filesIn(path("both")),
             (QStringList{"log.txt", "plots", "recordings", "repeat.csv", "repeat.yaml", "report.html",
                          "result.yaml", "run_session.yaml"}));
    QCOMPARE(filesIn(path("both/recordings")).size(), 2);
    QVERIFY(readFile(path("both/repeat.yaml")).startsWith("evical_repeat: 1\nverdict: unchanged\n"));
    const QString result = path("both/result.yaml");
    VERIFY_OUTCOME(runProgram({"compare", result, simulated("short") + "/truth.yaml"}), 0);
    VERIFY_OUTCOME(runProgram({"export", result, "--to", "kalibr", "-o", path("kalibr")}), 0);
    const Outcome check = runProgram({"check", path("both"), session("second")});
    QVERIFY2(check.exit_code == 0 || check.exit_code == 4, qPrintable(check.output + check.errors));
    // Again into the same folder, which has its own results.
    const Outcome json =
        runProgram({"repeat", session("first"), session("second"), "-o", path("both"), "--json"});
    VERIFY_OUTCOME(json, 0);
    const QJsonObject object = QJsonDocument::fromJson(json.output.toUtf8()).object();
    QCOMPARE(object["verdict"].toString(), QString("unchanged"));
    QCOMPARE(object["recordings"].toArray().size(), 2);
    QVERIFY(object["quantities"].toArray().size() >= 5);
    QVERIFY2(json.errors.isEmpty(), qPrintable(json.errors));
  }

  void fewerThanTwo_endsWith4AndSaysWhy() {
    const Outcome outcome = runProgram({"repeat", session("early"), session("late"), "-o", path("few")});
    VERIFY_OUTCOME(outcome, 4);
    QVERIFY2(outcome.output.contains(QRegularExpression(
                 "cannot tell: 1 of 2 recordings could be calibrated.*too short.*\nto do: ")),
             qPrintable(outcome.output));
    QVERIFY(readFile(path("few/repeat.yaml")).contains("verdict: cannot_tell"));
    QVERIFY(!QFile::exists(path("few/result.yaml")));
  }

  void badInput_endsWith2_data() {
    QTest::addColumn<QStringList>("sessions");
    QTest::addColumn<QString>("part");
    QTest::newRow("one only") << QStringList{"first"} << "a single recording";
    QTest::newRow("one listed") << QStringList{"one_listed"} << "a single recording";
    QTest::newRow("another board") << QStringList{"first", "other_board"}
                                   << "board is asymmetric_circles 9 x 4";
    QTest::newRow("another rig") << QStringList{"first", "other_rig"} << "cameras is right";
    QTest::newRow("missing session") << QStringList{"first", "nowhere"} << "nowhere.yaml";
    QTest::newRow("missing recording") << QStringList{"first", "no_file"} << "does not exist";
    QTest::newRow("missing in list") << QStringList{"list"} << "nowhere.bag' does not exist";
    QTest::newRow("twice") << QStringList{"first", "first"} << "is listed twice";
    QTest::newRow("twice in a list") << QStringList{"copies"} << "is listed twice";
    QTest::newRow("overlap") << QStringList{"first", "overlapping"} << "is listed twice";
    QTest::newRow("twice by another path") << QStringList{"formats"} << "is listed twice";
  }
  void badInput_endsWith2() {
    QFETCH(QStringList, sessions);
    QFETCH(QString, part);
    QStringList arguments = {"repeat", "-o", path("bad")};
    for (const QString& each : sessions) arguments += session(each);
    const Outcome outcome = runProgram(arguments);
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, part);
    QVERIFY(!QDir(path("bad")).exists());
  }

  void listOfRecordings_isForRepeatOnly() {
    const Outcome outcome = runProgram({"calibrate", session("copies"), "-o", path("bad")});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "evical repeat");
  }

  void resultInTheWay_isKept() {
    QVERIFY(QDir().mkpath(path("kept")));
    writeFile(path("kept/result.yaml"), "mine");
    const Outcome outcome = runProgram({"repeat", session("first"), session("second"), "-o", path("kept")});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "contains the result of a calibration");
    QCOMPARE(readFile(path("kept/result.yaml")), QByteArray("mine"));
    writeFile(path("file"), "a file");
    VERIFY_OUTCOME(runProgram({"repeat", session("first"), session("second"), "-o", path("file")}), 2);
  }

  void interrupted_endsWith1_andLeavesNoVerdict() {
    const Outcome outcome = interruptProgram(
        {"repeat", session("first"), session("second"), "-o", path("cut")}, SIGINT,
        [](const QString& errors) { return errors.contains("first") || errors.contains("detect"); });
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_SAYS(outcome, "cancelled");
    QVERIFY(!QFile::exists(path("cut/repeat.yaml")));
  }
};

EVICAL_TEST(TestRepeatCommand)
#include "tst_repeat_command.moc"
