// Everything that people hand to `evical calibrate` by mistake: the exit code tells whose fault it is, the
// last line says what, where and what to do, and no half-written result stays behind.
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QDir>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <csignal>
#include <functional>

using namespace evical::test;

namespace {

// A session of its own with links to a simulated recording; tests change one thing about it.
class Case {
 public:
  explicit Case(const QString& recording = "short") {
    for (const QString& file : filesIn(simulated(recording)))
      if (file != "session.yaml") QFile::link(simulated(recording) + "/" + file, path(file));
    session_ = readFile(simulated(recording) + "/session.yaml");
    writeFile(session(), session_);
  }

  QString path(const QString& name) const { return folder_.filePath(name); }
  QString session() const { return path("session.yaml"); }
  QString result() const { return path("result"); }

  void change(const QString& from, const QString& to) {
    QString text = QString::fromUtf8(session_);
    QVERIFY2(text.contains(from), qPrintable("the session has no '" + from + "'"));
    session_ = text.replace(from, to).toUtf8();
    writeFile(session(), session_);
  }
  void append(const QString& text) {
    session_ += text.toUtf8();
    writeFile(session(), session_);
  }
  void replace(const QString& file, const QByteArray& content) {
    QFile::remove(path(file));
    writeFile(path(file), content);
  }
  // Each line's numbers through `edit`, which may clear a line to drop it.
  void editLines(const QString& file, const std::function<void(QList<double>&)>& edit) {
    QByteArray edited;
    for (const QByteArray& line : readFile(path(file)).split('\n')) {
      QList<double> numbers;
      for (const QByteArray& number : line.simplified().split(' '))
        if (!number.isEmpty()) numbers.append(number.toDouble());
      if (!numbers.isEmpty()) edit(numbers);
      if (numbers.isEmpty()) continue;
      for (int i = 0; i < numbers.size(); ++i)
        edited += (i == 0 ? "" : " ") + QByteArray::number(numbers[i], 'f', 9);
      edited += '\n';
    }
    replace(file, edited);
  }

  Outcome calibrate(const QStringList& more = {}) const {
    return runProgram(QStringList{"calibrate", session(), "-o", result()} + more);
  }

 private:
  QTemporaryDir folder_;
  QByteArray session_;
};

#define VERIFY_OUTCOME(outcome, code)     \
  QVERIFY2((outcome).exit_code == (code), \
           qPrintable(QStringLiteral("exit code %1\n").arg((outcome).exit_code) + (outcome).errors))
#define VERIFY_SAYS(outcome, part) \
  QVERIFY2((outcome).reason().contains(QRegularExpression(part)), qPrintable("reason: " + (outcome).reason()))

// Rejected before anything is written.
#define VERIFY_REJECTED(test, outcome, part) \
  VERIFY_OUTCOME(outcome, 2);                \
  VERIFY_SAYS(outcome, part);                \
  QVERIFY2(!QDir((test).result()).exists(), "a folder for results was made")

// Failed while at work: the folder, if there is one, holds the reason and nothing half-written.
#define VERIFY_FAILED(test, outcome, part)                                        \
  VERIFY_OUTCOME(outcome, 1);                                                     \
  VERIFY_SAYS(outcome, part);                                                     \
  QVERIFY(!QDir((test).result()).exists() ||                                      \
          readFile((test).result() + "/result.yaml").contains("status: failed")); \
  for (const QString& file : filesIn((test).result()))                            \
  QVERIFY2((QStringList{"result.yaml", "log.txt", "report.html", "plots"}).contains(file), qPrintable(file))

}  // namespace

class TestBadInput : public QObject {
  Q_OBJECT

 private slots:
  void session_thatIsMissing_isNamed();
  void session_thatIsNoYaml_isRefusedWithTheLine();
  void session_thatIsAFolder_isRefused();
  void session_withAMistake_isRefusedAtItsPlace_data();
  void session_withAMistake_isRefusedAtItsPlace();
  void option_thatIsUnknownOrOutOfRange_isRefused();
  void recording_thatIsMissing_isNamed();
  void recording_ofNoKnownFormat_isRefused();
  void streams_thatAreNotThere_areListedWithThoseThatAre();
  void streams_thatAreEmpty_areRefused();
  void resolution_tooSmallForTheEvents_isRefused();
  void bag_cutShort_isReadAsFarAsItIsWhole();
  void bag_withABrokenChunk_isReadAroundIt();
  void bag_withoutAWholeChunk_isRefused();
  void events_outOfOrder_areReported();
  void imuGap_isReportedWithItsPlace();
  void sensors_withoutOverlap_areRefusedWithBothRanges();
  void accelerations_inG_areRecognised();
  void angularRates_inDegrees_areRecognised();
  void board_thatIsNeverSeen_saysWhereWindowsWereLost();
  void board_ofAnotherSize_isNamed_data();
  void board_ofAnotherSize_isNamed();
  void boardSpacing_tenPercentOff_isDoubtful_data();
  void boardSpacing_tenPercentOff_isDoubtful();
  void recording_tooShort_fails();
  void recording_withoutMotion_fails();
  void init_ofNoSession_writesNone_data();
  void init_ofNoSession_writesNone();
};

void TestBadInput::init_ofNoSession_writesNone_data() {
  QTest::addColumn<QStringList>("recordings");
  QTest::addColumn<QString>("says");
  QTest::newRow("none") << QStringList{} << "RECORDING";
  QTest::newRow("missing") << QStringList{"gone.bag"} << "gone.bag";
  QTest::newRow("of no known format") << QStringList{"other.bag"} << "other.bag.*format";
  QTest::newRow("no events") << QStringList{"imu.txt"} << "imu.txt.*no events";
  QTest::newRow("useless") << QStringList{"cut.bag"} << "cut.bag";
  QTest::newRow("a further one that is useless") << QStringList{"events.txt", "cut.bag"} << "cut.bag";
  QTest::newRow("given twice") << QStringList{"events.txt", "events.txt"} << "already another sensor's";
}

void TestBadInput::init_ofNoSession_writesNone() {
  QFETCH(QStringList, recordings);
  QFETCH(QString, says);
  QTemporaryDir folder;
  for (const QString name : {"events.txt", "imu.txt"})
    QFile::link(simulated("short") + "/" + name, folder.filePath(name));
  writeFile(folder.filePath("other.bag"), QByteArray(5000, '\x07'));
  writeFile(folder.filePath("cut.bag"), readFile(simulated("short_bag") + "/recording.bag").left(5000));
  const QStringList before = filesIn(folder.path());
  QStringList command = {"init", "-o", folder.filePath("session.yaml")};
  for (const QString& recording : recordings) command << folder.filePath(recording);
  const Outcome outcome = runProgram(command);
  VERIFY_OUTCOME(outcome, 2);
  VERIFY_SAYS(outcome, says);
  QCOMPARE(filesIn(folder.path()), before);
}

void TestBadInput::session_thatIsMissing_isNamed() {
  QTemporaryDir folder;
  const Outcome outcome =
      runProgram({"calibrate", folder.filePath("nowhere.yaml"), "-o", folder.filePath("result")});
  VERIFY_OUTCOME(outcome, 2);
  VERIFY_SAYS(outcome, "nowhere.yaml.*does not exist");
  QVERIFY(filesIn(folder.path()).isEmpty());
}

void TestBadInput::session_thatIsNoYaml_isRefusedWithTheLine() {
  Case test;
  writeFile(test.session(), "evical_session: 1\nboard: {rows: 3\ncameras: ]\n");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "session.yaml.*line [23].*YAML");
}

void TestBadInput::session_thatIsAFolder_isRefused() {
  Case test;
  const Outcome outcome = runProgram({"calibrate", test.path(""), "-o", test.result()});
  VERIFY_REJECTED(test, outcome, "folder");
}

void TestBadInput::session_withAMistake_isRefusedAtItsPlace_data() {
  QTest::addColumn<QString>("from");
  QTest::addColumn<QString>("to");
  QTest::addColumn<QString>("says");
  QTest::newRow("unknown key") << "recording:"
                               << "recordng:"
                               << "recordng.*[Dd]id you mean 'recording'";
  QTest::newRow("unknown board key") << "  rows:"
                                     << "  row:"
                                     << "board.row .*[Dd]id you mean 'rows'";
  QTest::newRow("unknown camera key") << "    stream: events.txt"
                                      << "    streem: events.txt"
                                      << "streem.*[Dd]id you mean 'stream'";
  QTest::newRow("wrong type") << "rows: 11"
                              << "rows: eleven"
                              << "rows.*eleven.*whole number";
  QTest::newRow("out of range") << "rows: 11"
                                << "rows: 0"
                                << "rows";
  QTest::newRow("circles that touch") << "radius_m: 0.02"
                                      << "radius_m: 0.2"
                                      << "radius|touch|overlap";
  QTest::newRow("symmetric board") << "asymmetric_circles"
                                   << "symmetric_circles"
                                   << "180|half turn|turned";
  QTest::newRow("even number of rows") << "rows: 11"
                                       << "rows: 10"
                                       << "180|half turn|turned";
  QTest::newRow("unknown unit") << "acceleration_unit: m/s^2"
                                << "acceleration_unit: ft/s^2"
                                << "acceleration_unit.*ft";
  QTest::newRow("unknown reference") << "reference: left_imu"
                                     << "reference: right_imu"
                                     << "reference.*right_imu";
  QTest::newRow("no version") << "evical_session: 1"
                              << "evical_session: 99"
                              << "evical_session";
}

void TestBadInput::session_withAMistake_isRefusedAtItsPlace() {
  QFETCH(QString, from);
  QFETCH(QString, to);
  QFETCH(QString, says);
  Case test;
  test.change(from, to);
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, says);
  VERIFY_SAYS(outcome, "session.yaml");
}

void TestBadInput::option_thatIsUnknownOrOutOfRange_isRefused() {
  Case test;
  Outcome outcome = test.calibrate({"--set", "detection.methd=ring_vote"});
  VERIFY_REJECTED(test, outcome, "detection.methd.*'(detection.)?method'");
  outcome = test.calibrate({"--set", "detection.longest_window_s=7"});
  VERIFY_REJECTED(test, outcome, "detection.longest_window_s.*7 s.*0.2 s");
  test.append("options: {detection.method: guess}\n");
  outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "guess.*ring_vote");
}

void TestBadInput::recording_thatIsMissing_isNamed() {
  Case test;
  test.change("recording: \".\"", "recording: gone.bag");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "gone.bag");
}

void TestBadInput::recording_ofNoKnownFormat_isRefused() {
  Case test;
  writeFile(test.path("other.bag"), QByteArray(5000, '\x07'));
  test.change("recording: \".\"", "recording: other.bag");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "other.bag.*format");
}

void TestBadInput::streams_thatAreNotThere_areListedWithThoseThatAre() {
  Case test("short_bag");
  test.change("stream: /davis_left/events", "stream: /davis_right/events");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "/davis_right/events.*/davis_left/events");
}

void TestBadInput::streams_thatAreEmpty_areRefused() {
  Case test;
  test.replace("imu.txt", "");
  Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "imu|IMU");
  Case events;
  events.replace("events.txt", "");
  outcome = events.calibrate();
  VERIFY_REJECTED(events, outcome, "events");
}

void TestBadInput::resolution_tooSmallForTheEvents_isRefused() {
  Case test;
  test.change("resolution_px: [346, 260]", "resolution_px: [240, 180]");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "240.*180");
}

void TestBadInput::bag_cutShort_isReadAsFarAsItIsWhole() {
  Case test("short_bag");
  const QByteArray bag = readFile(test.path("recording.bag"));
  test.replace("recording.bag", bag.left(bag.size() * 9 / 10));
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  QVERIFY2(outcome.errors.contains(QRegularExpression("truncated|cut|ends|lost")),
           qPrintable(outcome.errors));
  QVERIFY(readFile(test.result() + "/result.yaml").contains("notes:"));
}

void TestBadInput::bag_withABrokenChunk_isReadAroundIt() {
  Case test("short_bag");
  QByteArray bag = readFile(test.path("recording.bag"));
  for (qsizetype i = 0; i < 2000; ++i) bag[bag.size() / 2 + i] = '\x55';
  test.replace("recording.bag", bag);
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  QVERIFY2(outcome.errors.contains(QRegularExpression("corrupt|damaged|broken|lost")),
           qPrintable(outcome.errors));
}

void TestBadInput::bag_withoutAWholeChunk_isRefused() {
  Case test("short_bag");
  test.replace("recording.bag", readFile(test.path("recording.bag")).left(6000));
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "recording.bag");
}

void TestBadInput::events_outOfOrder_areReported() {
  Case test;
  // Two neighbouring blocks change places.
  const QByteArray events = readFile(test.path("events.txt"));
  const auto lineAfter = [&](qsizetype at) { return events.indexOf('\n', at) + 1; };
  const qsizetype first = lineAfter(events.size() / 2), second = lineAfter(first + 20'000),
                  end = lineAfter(second + 20'000);
  test.replace("events.txt", events.left(first) + events.mid(second, end - second) +
                                 events.mid(first, second - first) + events.mid(end));
  const Outcome outcome = test.calibrate();
  QVERIFY2(outcome.errors.contains(QRegularExpression("out of order|backwards")), qPrintable(outcome.errors));
  VERIFY_OUTCOME(outcome, 0);
}

void TestBadInput::imuGap_isReportedWithItsPlace() {
  Case test;
  const double start_s = readFile(test.path("imu.txt")).split(' ').first().toDouble();
  test.editLines("imu.txt", [&](QList<double>& sample) {
    if (sample[0] - start_s > 3.0 && sample[0] - start_s < 3.2) sample.clear();
  });
  const Outcome outcome = test.calibrate();
  QVERIFY2(outcome.errors.contains(QRegularExpression("no samples for")), qPrintable(outcome.errors));
  QVERIFY2(outcome.errors.contains(QRegularExpression("from 3\\.0\\d* s on")), qPrintable(outcome.errors));
}

void TestBadInput::sensors_withoutOverlap_areRefusedWithBothRanges() {
  Case test;
  test.editLines("imu.txt", [](QList<double>& sample) { sample[0] += 100.0; });
  const Outcome outcome = test.calibrate();
  QVERIFY2(outcome.exit_code == 1 || outcome.exit_code == 2, qPrintable(outcome.errors));
  VERIFY_SAYS(outcome, "overlap");
  VERIFY_SAYS(outcome, "100|10[56]");
  QVERIFY(!QFile::exists(test.result() + "/trajectory.csv"));
}

void TestBadInput::accelerations_inG_areRecognised() {
  Case test;
  test.editLines("imu.txt", [](QList<double>& sample) {
    for (int i = 1; i <= 3; ++i) sample[i] /= 9.81;
  });
  Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "acceleration_unit: g");
  test.change("acceleration_unit: m/s^2", "acceleration_unit: g");
  outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
}

void TestBadInput::angularRates_inDegrees_areRecognised() {
  Case test;
  test.editLines("imu.txt", [](QList<double>& sample) {
    for (int i = 4; i <= 6; ++i) sample[i] *= 57.29577951308232;
  });
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "angular_rate_unit: deg/s");
}

void TestBadInput::board_thatIsNeverSeen_saysWhereWindowsWereLost() {
  Case test;
  test.change("circles: dark", "circles: bright");
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, "never (found|seen).*\\d+ windows.*\\(.*(bright|circles)");
}

void TestBadInput::board_ofAnotherSize_isNamed_data() {
  QTest::addColumn<int>("rows");
  QTest::addColumn<int>("cols");
  QTest::addColumn<QString>("says");
  QTest::newRow("fewer rows") << 9 << 4
                              << "left: .*larger than 9 x 4: .*beyond its first or last row in \\d+ % of";
  QTest::newRow("fewer columns") << 11 << 3 << "larger than 11 x 3: .*beyond its first or last column";
  QTest::newRow("fewer of both") << 7 << 3 << "larger than 7 x 3: .*first or last row.*first or last column";
  QTest::newRow("more rows") << 13 << 4 << "smaller than 13 x 4: .*rows? w.* never seen in \\d+ views";
  QTest::newRow("more columns") << 11 << 5 << "smaller than 11 x 5: .*column";
  QTest::newRow("more of both")
      << 13 << 7 << "smaller than 13 x 7: .*columns? w.* never seen in \\d+ views|no 13 x 7 board";
}

void TestBadInput::board_ofAnotherSize_isNamed() {
  QFETCH(int, rows);
  QFETCH(int, cols);
  QFETCH(QString, says);
  Case test;
  test.change("rows: 11", QString("rows: %1").arg(rows));
  test.change("cols: 4", QString("cols: %1").arg(cols));
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, says);
  VERIFY_SAYS(outcome, "[Cc]heck rows(,| and) cols .*in the session");
}

void TestBadInput::boardSpacing_tenPercentOff_isDoubtful_data() {
  QTest::addColumn<QString>("spacing_m");
  QTest::addColumn<QString>("says");
  QTest::newRow("right") << "0.05" << QString();
  QTest::newRow("too small") << "0.0455"
                             << "(9|10|11) % larger than spacing_m says";
  QTest::newRow("too large") << "0.0556"
                             << "(9|10|11) % smaller than spacing_m says";
}

void TestBadInput::boardSpacing_tenPercentOff_isDoubtful() {
  QFETCH(QString, spacing_m);
  QFETCH(QString, says);
  Case test;
  test.change("spacing_m: 0.05", "spacing_m: " + spacing_m);
  test.change("radius_m: 0.02", QString("radius_m: %1").arg(0.4 * spacing_m.toDouble()));
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  const QString result = QString::fromUtf8(readFile(test.result() + "/result.yaml"));
  const bool warned = outcome.errors.contains(QRegularExpression("warning: .*spacing_m says.*measure it"));
  QVERIFY2(warned == !says.isEmpty(), qPrintable(outcome.errors));
  if (says.isEmpty()) return;
  QVERIFY2(result.contains("status: doubtful"), qPrintable(result.left(400)));
  QVERIFY2(result.contains(QRegularExpression("reason: .*" + says)), qPrintable(result.left(400)));
}

void TestBadInput::recording_tooShort_fails() {
  Case test;
  test.append("time_range_s: [0, 0.6]\n");
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, "too short: 0\\.\\d+ s");
}

void TestBadInput::recording_withoutMotion_fails() {
  Case test("still");
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, "mov|motion");
}

EVICAL_TEST(TestBadInput)
#include "tst_bad_input.moc"
