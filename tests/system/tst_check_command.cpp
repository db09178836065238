// `evical check`: verdicts as exit codes, JSON alone on stdout, files, and users' mistakes.
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QRegularExpression>
#include <QTemporaryDir>

using namespace evical::test;

namespace {

// A short recording can detect only large changes.
const QStringList kCoarse = {
    "--set", "check.matters_rotation_deg=5",    "--set", "check.matters_translation_mm=500",
    "--set", "check.matters_time_offset_ms=50", "--set", "check.matters_lens_px=50"};

}  // namespace

class TestCheckCommand : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  QString path(const QString& name) const { return folder_.filePath(name); }
  QString recording() const { return simulated("short") + "/session.yaml"; }
  QString result() const { return path("result"); }

 private slots:
  void initTestCase() {
    const Outcome outcome = runProgram({"calibrate", recording(), "-o", result(), "--quiet"});
    VERIFY_OUTCOME(outcome, 0);
  }

  void unchanged_endsWith0() {
    const Outcome outcome = runProgram(
        QStringList{"check", result(), simulated("second") + "/session.yaml", "-o", path("good")} + kCoarse);
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY2(outcome.output.contains("unchanged: "), qPrintable(outcome.output));
    QVERIFY2(outcome.output.contains(
                 QRegularExpression("left.translation.x \\[mm\\] +[0-9.]+ \\+- [0-9.]+ +[0-9.]+ \\+-")),
             qPrintable(outcome.output));
    QVERIFY(!outcome.output.contains('<'));
    QCOMPARE(filesIn(path("good")), (QStringList{"check.yaml", "log.txt", "plots", "report.html"}));
    QVERIFY(readFile(path("good") + "/check.yaml").startsWith("evical_check: 1\nverdict: unchanged\n"));
  }

  // The recording of the calibration, and the same data in another folder.
  void ownRecording_cannotTell() {
    QDir().mkpath(path("copy"));
    for (const QString name : {"events.txt", "imu.txt", "session.yaml"})
      QVERIFY(QFile::copy(simulated("short") + "/" + name, path("copy/" + name)));
    for (const QString& own : {recording(), path("copy/session.yaml")}) {
      const Outcome outcome = runProgram(QStringList{"check", result(), own} + kCoarse);
      VERIFY_OUTCOME(outcome, 4);
      QVERIFY2(outcome.output.contains("cannot tell: this is the recording of the old result"),
               qPrintable(outcome.output));
      QVERIFY2(outcome.output.contains("to do: Check with a new recording"), qPrintable(outcome.output));
    }
  }

  void changed_endsWith3() {
    QByteArray yaml = readFile(result() + "/result.yaml");
    const QString text = QString::fromUtf8(yaml);
    const QRegularExpression offset("(time_offset_s: )(0\\.00[0-9]+)");
    const QRegularExpressionMatch match = offset.match(text);
    QVERIFY(match.hasMatch());
    QString changed = text;
    changed.replace(match.captured(0),
                    match.captured(1) + QString::number(match.captured(2).toDouble() + 0.02, 'f', 9));
    writeFile(path("late.yaml"), changed.toUtf8());
    const Outcome outcome = runProgram(QStringList{"check", path("late.yaml"), recording()} + kCoarse);
    VERIFY_OUTCOME(outcome, 3);
    QVERIFY2(outcome.output.contains(QRegularExpression("changed: the time offset of left by (19|20|21)")),
             qPrintable(outcome.output));
  }

  // result.yaml was changed after run.data was written. The check of a recording with itself ends early.
  void resultOfAnotherRun_isNamedByAllWhoReadIt() {
    QDir().mkpath(path("edited"));
    QVERIFY(QFile::copy(result() + "/run.data", path("edited/run.data")));
    writeFile(path("edited/result.yaml"), readFile(result() + "/result.yaml") + "# by hand\n");
    for (const QString& folder : {path("edited"), result()}) {
      const bool edited = folder != result();
      const QString named = edited ? "warning: " + folder + "/result.yaml: run.data is not used: it belongs"
                                   : QString("run.data is not used");
      for (const QStringList& arguments :
           {QStringList{"check", folder, recording()} + kCoarse,
            QStringList{"compare", folder, simulated("short") + "/truth.yaml"},
            QStringList{"export", folder, "--to", "kalibr", "-o", path("exported")}}) {
        const QString errors = runProgram(arguments).errors;
        QVERIFY2(errors.contains(named) == edited, qPrintable(arguments.join(' ') + ": " + errors));
      }
    }
  }

  void cannotTell_endsWith4AndSaysWhatToDo() {
    const Outcome outcome = runProgram({"check", result(), simulated("second") + "/session.yaml", "--set",
                                        "check.matters_translation_mm=0.5"});
    VERIFY_OUTCOME(outcome, 4);
    QVERIFY2(outcome.output.contains(
                 QRegularExpression("cannot tell: .*translation of left below .* mm \\(required: 0.5\\)"
                                    ".*\nto do: [A-Z]")),
             qPrintable(outcome.output));
  }

  void json_isAllThereIs() {
    const Outcome outcome =
        runProgram(QStringList{"check", result(), simulated("second") + "/session.yaml", "--json"} + kCoarse);
    VERIFY_OUTCOME(outcome, 0);
    const QJsonObject json = QJsonDocument::fromJson(outcome.output.toUtf8()).object();
    QCOMPARE(json["verdict"].toString(), QString("unchanged"));
    QVERIFY(json["findings"].toArray().size() >= 4);
    QVERIFY(json["findings"].toArray()[0].toObject()["smallest_detectable_change"].toDouble() > 0.0);
    QVERIFY2(outcome.errors.isEmpty(), qPrintable(outcome.errors));
  }

  void badInput_endsWith2_data() {
    QTest::addColumn<QStringList>("arguments");
    QTest::addColumn<QString>("part");
    QTest::newRow("no result") << QStringList{path("nowhere"), recording()} << "nowhere.*does not exist";
    QTest::newRow("no recording") << QStringList{result(), path("none.bag")} << "none.bag.*does not exist";
    QTest::newRow("not a result") << QStringList{recording(), recording()} << "neither a result nor";
    QTest::newRow("stability below 0")
        << QStringList{result(), recording(), "--stability-rotation", "-1"} << "stability_rotation_deg";
    QTest::newRow("no session") << QStringList{path("alone.yaml"), simulated("short")} << "--session";
    QTest::newRow("another rig") << QStringList{result(), path("other.yaml")} << "'right'.*another rig";
  }
  void badInput_endsWith2() {
    QFETCH(QStringList, arguments);
    QFETCH(QString, part);
    writeFile(path("alone.yaml"), readFile(result() + "/result.yaml"));
    QString other = QString::fromUtf8(readFile(recording()));
    other.replace("  left:", "  right:").replace("recording: \".\"", "recording: " + simulated("short"));
    writeFile(path("other.yaml"), other.toUtf8());
    const Outcome outcome = runProgram(QStringList{"check"} + arguments + QStringList{"-o", path("bad")});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, part);
    QVERIFY(!QDir(path("bad")).exists());
  }
};

EVICAL_TEST(TestCheckCommand)
#include "tst_check_command.moc"
