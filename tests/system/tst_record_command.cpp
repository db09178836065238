// `evical record` and `evical watch`: live streams from the standard input, with every end that a recording
// can have.
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QFileInfo>
#include <QTemporaryDir>

#include <csignal>
#include <utility>

using namespace evical::test;

class TestRecordCommand : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  QString path(const QString& name) const { return folder_.filePath(name); }
  static QString bag() { return simulated("short_bag") + "/recording.bag"; }
  // Bytes of a file in `seconds`, in small pieces.
  static QString inTime(const QString& file, int seconds) {
    const qint64 pieces = 100L * seconds;
    return QStringLiteral(
               "for i in $(seq 0 %1); do dd if='%2' bs=%3 skip=$i count=1 status=none; sleep 0.01; done")
        .arg(pieces)
        .arg(file)
        .arg(QFileInfo(file).size() / pieces + 1);
  }
  static Contents read(const QString& file) { return readAll(file.toStdString()); }

 private slots:
  void standardInput_isRecorded_data() {
    QTest::addColumn<QString>("input");
    QTest::addColumn<QString>("output");
    for (const auto& [input, output] : {std::pair("bag", "mcap"),
                                        {"mcap", "aedat4"},
                                        {"aedat4", "bag"},
                                        {"raw", "mcap"},
                                        {"dat", "aedat4"}})
      QTest::addRow("%s to %s", input, output) << input << output;
  }

  void standardInput_isRecorded() {
    QFETCH(QString, input);
    QFETCH(QString, output);
    const QString source = path("source." + input), recorded = path("recorded." + output);
    VERIFY_OUTCOME(runProgram({"convert", bag(), "-o", source, "--quiet"}), 0);
    VERIFY_OUTCOME(runProgramOn("cat " + source, {"record", "-", "-o", recorded, "--quiet"}), 0);
    const Contents got = read(recorded), expected = read(source);
    QCOMPARE(got.eventCount(), expected.eventCount());
    QCOMPARE(got.sampleCount(), expected.sampleCount());
    QVERIFY(got.faults.empty());
  }

  void text_needsTheResolution() {
    const QString events = simulated("short") + "/events.txt", recorded = path("text.mcap");
    const Outcome without = runProgramOn("cat " + events, {"record", "-", "-o", recorded, "--quiet"});
    VERIFY_OUTCOME(without, 2);
    VERIFY_SAYS(without,
                "the standard input: the resolution of events is not in the stream. Give the "
                "resolution of the sensor, e.g. 346x260");
    VERIFY_OUTCOME(
        runProgramOn("cat " + events, {"record", "-", "-o", recorded, "--quiet", "--resolution", "346x260"}),
        0);
    QCOMPARE(read(recorded).eventCount(), read(events).eventCount());
    QCOMPARE(read(recorded).streams.front().name, "events");
  }

  void duration_endsIt() {
    const QString recorded = path("part.aedat4");
    const Outcome outcome =
        runProgramOn(inTime(bag(), 4), {"record", "-", "-o", recorded, "--quiet", "--duration", "1.5"});
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY2(outcome.output.startsWith("1.5 s, "), qPrintable(outcome.output));
    const Contents got = read(recorded);
    QVERIFY(got.faults.empty() && got.eventCount() > 0);
  }

  void interrupt_endsItProperly() {
    for (const int signal : {SIGINT, SIGTERM}) {
      const QString recorded = path("interrupted.mcap");
      const Outcome outcome =
          signalProgramOn(inTime(bag(), 5), {"record", "-", "-o", recorded, "--quiet"}, signal, 2500);
      VERIFY_OUTCOME(outcome, 0);
      QVERIFY(read(recorded).faults.empty());
      QVERIFY(read(recorded).eventCount() > 0);
    }
  }

  void interruptBeforeTheFirstData_keepsTheOldFile() {
    writeFile(path("old.mcap"), "kept");
    const Outcome outcome =
        signalProgramOn("sleep 20", {"record", "-", "-o", path("old.mcap"), "--quiet"}, SIGINT, 1000);
    VERIFY_OUTCOME(outcome, 1);
    QCOMPARE(readFile(path("old.mcap")), QByteArray("kept"));
  }

  // The file is readable, and nothing else is left.
  void killedProgram_leavesAFileThatOpens_data() {
    QTest::addColumn<QString>("format");
    QTest::addColumn<int>("after_ms");
    for (const auto& [format, after_ms] : {std::pair("bag", 1630), {"mcap", 2110}, {"aedat4", 1870}})
      QTest::newRow(format) << format << after_ms;
  }

  void killedProgram_leavesAFileThatOpens() {
    QFETCH(QString, format);
    QFETCH(int, after_ms);
    const QString recorded = path("killed." + format);
    QFile::remove(recorded);
    const Outcome outcome =
        signalProgramOn(inTime(bag(), 5), {"record", "-", "-o", recorded, "--quiet"}, SIGKILL, after_ms);
    QCOMPARE(outcome.exit_code, -1);
    const Contents got = read(recorded);
    QVERIFY(got.eventCount() > 0);
    QCOMPARE(filesIn(folder_.path()).filter("killed." + format), QStringList{"killed." + format});
  }

  void badStreams_areExplained_data() {
    QTest::addColumn<QString>("sender");
    QTest::addColumn<QString>("reason");
    QTest::newRow("nothing") << "true"
                             << "nothing arrived before its end";
    QTest::newRow("noise") << "head -c 100000 /dev/urandom"
                           << "the standard input: the format is unknown";
    QTest::newRow("cut header") << "head -c 60 " + bag() << "the standard input: ";
    QTest::newRow("endless noise") << "yes nothing"
                                   << "the standard input: the format is unknown";
    QTest::newRow("packed text")
        << "gzip -c " + simulated("short") + "/imu.txt; sleep 4"
        << "the standard input: text can only be read when it is complete. Write it into a file";
    QTest::newRow("web page") << "echo '<!DOCTYPE html><html>'"
                              << "this is a page of a web site";
  }

  void badStreams_areExplained() {
    QFETCH(QString, sender);
    QFETCH(QString, reason);
    const Outcome outcome = runProgramOn(sender, {"record", "-", "-o", path("bad.bag"), "--quiet"});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, reason);
    QVERIFY(!QFileInfo::exists(path("bad.bag")));
  }

  // The result is that of `evical calibrate` on the recorded file.
  void watch_calibratesAsTheFile() {
    const QString session = simulated("short_bag") + "/session.yaml", result = path("watched");
    const Outcome watched = runProgramOn("cat " + bag(), {"watch", "-", "--session", session, "-o", result});
    VERIFY_OUTCOME(watched, 0);
    QVERIFY2(watched.output.contains("watched.mcap (mcap)"), qPrintable(watched.output));
    QString text = QString::fromUtf8(readFile(session));
    text.replace(QRegularExpression("recording: .*"), "recording: " + result + ".mcap");
    writeFile(path("again.yaml"), text.toUtf8());
    VERIFY_OUTCOME(runProgram({"calibrate", path("again.yaml"), "-o", path("again"), "--quiet"}), 0);
    const auto stripped = [&](const QString& folder) {
      QString result_text = QString::fromUtf8(readFile(folder + "/result.yaml"));
      return result_text.remove(QRegularExpression("timing_s: .*"))
          .remove(QRegularExpression("memory_peak_mb: .*"));
    };
    QCOMPARE(stripped(result), stripped(path("again")));
  }

  void watch_namesWhatDoesNotFit() {
    const QString session = simulated("short_bag") + "/session.yaml";
    QString text = QString::fromUtf8(readFile(session));
    writeFile(path("other.yaml"),
              QString(text).replace(QRegularExpression("stream: .*events"), "stream: /nothing").toUtf8());
    const Outcome other = runProgramOn(
        "cat " + bag(), {"watch", "-", "--session", path("other.yaml"), "-o", path("other"), "--quiet"});
    VERIFY_OUTCOME(other, 2);
    VERIFY_SAYS(other, "the recording has no stream of type events");
    writeFile(path("lens.yaml"),
              text.replace(QRegularExpression("    intrinsics:\n(      .*\n)+"), "").toUtf8());
    const Outcome lens = runProgramOn(
        "cat " + bag(), {"watch", "-", "--session", path("lens.yaml"), "-o", path("lens"), "--quiet"});
    VERIFY_OUTCOME(lens, 2);
    VERIFY_SAYS(
        lens, "its lens is not given, so the board cannot be tracked live. Calibrate the camera alone first");
  }

  void badArguments_areExplained() {
    const Outcome format = runProgramOn("cat " + bag(), {"record", "-", "-o", path("x.h5")});
    VERIFY_OUTCOME(format, 2);
    VERIFY_SAYS(format, "dsec: this format cannot be written live. Choose one of: bag, mcap, aedat4");
    VERIFY_OUTCOME(runProgramOn("cat " + bag(), {"record", "-", "-o", "/proc/x.bag"}), 1);
    VERIFY_OUTCOME(runProgram({"record", "-o", path("x.bag")}), 2);
  }
};

EVICAL_TEST(TestRecordCommand)
#include "tst_record_command.moc"
