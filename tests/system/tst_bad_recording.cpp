// Recordings that are missing, damaged, or different from the session.
#include "core/recording/recording_reader.h"
#include "core/recording/recording_writer.h"
#include "tests/system/session_case.h"

#include <QElapsedTimer>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

using namespace evical::test;

class TestBadRecording : public QObject {
  Q_OBJECT

 private slots:
  void recording_thatIsMissing_isNamed();
  void recording_ofNoKnownFormat_isRefused();
  void streams_thatAreNotThere_areListedWithThoseThatAre();
  void streams_thatAreEmpty_areRefused();
  void resolution_tooSmallForTheEvents_isRefused();
  void bag_cutShort_isReadAsFarAsItIsWhole();
  void bag_withABrokenChunk_isReadAroundIt();
  void bag_withoutAWholeChunk_isRefused();
  void events_outOfOrder_areReported();
  void eventStamps_thatLie_costNothing_data();
  void eventStamps_thatLie_costNothing();
  void imuSamples_thatAreNoNumbers_areLeftOut();
  void imuGap_isReportedWithItsPlace();
  void sensors_withoutOverlap_areRefusedWithBothRanges();
  void accelerations_inG_areRecognised();
  void angularRates_inDegrees_areRecognised();
  void init_ofNoSession_writesNone_data();
  void init_ofNoSession_writesNone();
  void coarseStamps_areSaid();
  void pictures_thatAllCannotBeRead_areNamed();
};

void TestBadRecording::recording_thatIsMissing_isNamed() {
  SessionCase test;
  test.change("recording: \".\"", "recording: gone.bag");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "gone.bag");
}

void TestBadRecording::recording_ofNoKnownFormat_isRefused() {
  SessionCase test;
  writeFile(test.path("other.bag"), QByteArray(5000, '\x07'));
  test.change("recording: \".\"", "recording: other.bag");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "other.bag.*format");
}

void TestBadRecording::streams_thatAreNotThere_areListedWithThoseThatAre() {
  SessionCase test("short_bag");
  test.change("stream: /davis_left/events", "stream: /davis_right/events");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "/davis_right/events.*/davis_left/events");
}

void TestBadRecording::streams_thatAreEmpty_areRefused() {
  SessionCase test;
  test.replace("imu.txt", "");
  Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "imu|IMU");
  SessionCase events;
  events.replace("events.txt", "");
  outcome = events.calibrate();
  VERIFY_REJECTED(events, outcome, "events");
}

void TestBadRecording::resolution_tooSmallForTheEvents_isRefused() {
  SessionCase test;
  test.change("resolution_px: [346, 260]", "resolution_px: [240, 180]");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "240.*180");
}

void TestBadRecording::bag_cutShort_isReadAsFarAsItIsWhole() {
  SessionCase test("short_bag");
  const QByteArray bag = readFile(test.path("recording.bag"));
  test.replace("recording.bag", bag.left(bag.size() * 9 / 10));
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  QVERIFY2(outcome.errors.contains(QRegularExpression("truncated|cut|ends|lost")),
           qPrintable(outcome.errors));
  QVERIFY(readFile(test.result() + "/result.yaml").contains("notes:"));
}

void TestBadRecording::bag_withABrokenChunk_isReadAroundIt() {
  SessionCase test("short_bag");
  QByteArray bag = readFile(test.path("recording.bag"));
  for (qsizetype i = 0; i < 2000; ++i) bag[bag.size() / 2 + i] = '\x55';
  test.replace("recording.bag", bag);
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  QVERIFY2(outcome.errors.contains(QRegularExpression("corrupt|damaged|broken|lost")),
           qPrintable(outcome.errors));
}

void TestBadRecording::bag_withoutAWholeChunk_isRefused() {
  SessionCase test("short_bag");
  test.replace("recording.bag", readFile(test.path("recording.bag")).left(6000));
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "recording.bag");
}

void TestBadRecording::events_outOfOrder_areReported() {
  SessionCase test;
  // Two neighbouring blocks are exchanged.
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

void TestBadRecording::eventStamps_thatLie_costNothing_data() {
  QTest::addColumn<double>("where");  // position in the file
  QTest::addColumn<double>("moved_s");
  const double kDay_s = 86'400.0;
  QTest::newRow("20 s ahead") << 0.5 << 20.0;
  QTest::newRow("a day ahead") << 0.5 << kDay_s;
  QTest::newRow("the last a day ahead") << 1.0 << kDay_s;
  QTest::newRow("the first 0") << 0.0 << 0.0;
}

// One line of the events has another time: that event is lost, and the loss is reported.
void TestBadRecording::eventStamps_thatLie_costNothing() {
  QFETCH(double, where);
  QFETCH(double, moved_s);
  SessionCase test;
  QByteArray events = readFile(test.path("events.txt")).trimmed();
  const qsizetype at = static_cast<qsizetype>(where * static_cast<double>(events.size() - 1));
  const qsizetype begin = events.lastIndexOf('\n', at) + 1, end = events.indexOf(' ', begin);
  const double time_s = events.mid(begin, end - begin).toDouble();
  events.replace(begin, end - begin, where == 0.0 ? "0.0" : QByteArray::number(time_s + moved_s, 'f', 9));
  test.replace("events.txt", events + '\n');
  QElapsedTimer timer;
  timer.start();
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  QVERIFY2(outcome.errors.contains("1 event excluded, whose timestamps"), qPrintable(outcome.errors));
  QVERIFY2(!outcome.errors.contains("time runs backwards"), qPrintable(outcome.errors));
  QVERIFY2(timer.elapsed() < 60'000, qPrintable(QString::number(timer.elapsed())));
}

// A bag, since text does not represent NaN samples.
void TestBadRecording::imuSamples_thatAreNoNumbers_areLeftOut() {
  SessionCase test("short_bag");
  const std::string whole = test.path("recording.bag").toStdString(),
                    spoilt = test.path("spoilt.bag").toStdString();
  const std::unique_ptr<evical::RecordingReader> reader = evical::openRecording(whole);
  const std::unique_ptr<evical::RecordingWriter> writer =
      evical::createRecording(spoilt, "bag", reader->streams());
  evical::Packet packet;
  std::size_t samples = 0;
  while (reader->read(packet)) {
    const evical::StreamInfo& stream = reader->streams()[packet.stream];
    std::vector<evical::ImuSample> si;
    evical::toSi(packet.imu_samples, stream.acceleration_unit, stream.angular_rate_unit, si);
    for (evical::ImuSample& sample : si)
      if (samples++ == 500) sample.specific_force_m_s2.x() = std::nan("");
    if (!packet.events.empty()) writer->write(packet.stream, packet.events);
    if (!si.empty()) writer->write(packet.stream, si);
  }
  writer->finish();
  test.change("recording: recording.bag", "recording: spoilt.bag");
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  QVERIFY2(outcome.errors.contains("1 IMU sample excluded, whose values are not finite"),
           qPrintable(outcome.errors));
}

void TestBadRecording::imuGap_isReportedWithItsPlace() {
  SessionCase test;
  const double start_s = readFile(test.path("imu.txt")).split(' ').first().toDouble();
  test.editLines("imu.txt", [&](QList<double>& sample) {
    if (sample[0] - start_s > 3.0 && sample[0] - start_s < 3.2) sample.clear();
  });
  const Outcome outcome = test.calibrate();
  QVERIFY2(outcome.errors.contains(QRegularExpression("no samples for")), qPrintable(outcome.errors));
  QVERIFY2(outcome.errors.contains(QRegularExpression("from 3\\.0\\d* s on")), qPrintable(outcome.errors));
}

void TestBadRecording::sensors_withoutOverlap_areRefusedWithBothRanges() {
  SessionCase test;
  test.editLines("imu.txt", [](QList<double>& sample) { sample[0] += 100.0; });
  const Outcome outcome = test.calibrate();
  QVERIFY2(outcome.exit_code == 1 || outcome.exit_code == 2, qPrintable(outcome.errors));
  VERIFY_SAYS(outcome, "overlap");
  VERIFY_SAYS(outcome, "100|10[56]");
  QVERIFY(!QFile::exists(test.result() + "/trajectory.csv"));
}

void TestBadRecording::accelerations_inG_areRecognised() {
  SessionCase test;
  test.editLines("imu.txt", [](QList<double>& sample) {
    for (int i = 1; i <= 3; ++i) sample[i] /= 9.81;
  });
  Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "acceleration_unit: g");
  test.change("acceleration_unit: m/s^2", "acceleration_unit: g");
  outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
}

void TestBadRecording::angularRates_inDegrees_areRecognised() {
  SessionCase test;
  test.editLines("imu.txt", [](QList<double>& sample) {
    for (int i = 4; i <= 6; ++i) sample[i] *= 57.29577951308232;
  });
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "angular_rate_unit: deg/s");
}

void TestBadRecording::init_ofNoSession_writesNone_data() {
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

void TestBadRecording::init_ofNoSession_writesNone() {
  QFETCH(QStringList, recordings);
  QFETCH(QString, says);
  QTemporaryDir folder;
  for (const QString name : {"events.txt", "imu.txt"})
    QFile::link(simulated("short") + "/" + name, folder.filePath(name));
  writeFile(folder.filePath("other.bag"), QByteArray(5000, '\x07'));
  writeFile(folder.filePath("cut.bag"), readFile(simulated("short_bag") + "/recording.bag").left(4400));
  const QStringList before = filesIn(folder.path());
  QStringList command = {"init", "-o", folder.filePath("session.yaml")};
  for (const QString& recording : recordings) command << folder.filePath(recording);
  const Outcome outcome = runProgram(command);
  VERIFY_OUTCOME(outcome, 2);
  VERIFY_SAYS(outcome, says);
  QCOMPARE(filesIn(folder.path()), before);
}

// Rounded stamps make the time offset uncertain, by its sigma, and that is the reported reason.
void TestBadRecording::coarseStamps_areSaid() {
  QTemporaryDir folder;
  for (const QString name : {"imu.txt", "session.yaml", "truth.yaml"})
    QFile::copy(simulated("short") + "/" + name, folder.filePath(name));
  QByteArray rounded;
  for (const QByteArray& line : readFile(simulated("short") + "/events.txt").split('\n')) {
    const qsizetype blank = line.indexOf(' ');
    if (blank < 0) continue;
    rounded += QByteArray::number(0.005 * std::floor(line.left(blank).toDouble() / 0.005), 'f', 3) +
               line.mid(blank) + '\n';
  }
  writeFile(folder.filePath("events.txt"), rounded);
  const Outcome inspected = runProgram({"inspect", folder.path()});
  VERIFY_TEXT(inspected.output, "encoding: .*The time stamps step by 5 ms");
  const QString out = folder.filePath("out");
  const Outcome outcome = runProgram({"calibrate", folder.filePath("session.yaml"), "-o", out});
  VERIFY_OUTCOME(outcome, 0);
  VERIFY_TEXT(QString::fromUtf8(readFile(out + "/result.yaml")),
              "status: doubtful\nreason: .*event time stamps of left have steps of 5 ms");
  const Outcome compared = runProgram({"compare", out + "/result.yaml", folder.filePath("truth.yaml")});
  const auto match = QRegularExpression("left\\.time_offset.* (-?\\d+\\.\\d+)\\n").match(compared.output);
  QVERIFY2(match.hasMatch(), qPrintable(compared.output));
  QVERIFY2(std::abs(match.captured(1).toDouble()) < 2.0, qPrintable(compared.output));  // sigmas
}

// Two pictures with a header that states 2^31 - 1 pixels each way.
void TestBadRecording::pictures_thatAllCannotBeRead_areNamed() {
  QTemporaryDir folder;
  QDir(folder.path()).mkdir("pictures");
  const QByteArray huge = QByteArray::fromHex("89504e470d0a1a0a0000000d494844527fffffff7fffffff0800000000") +
                          QByteArray(64, '\0');
  for (const char* name : {"1700000000000000000.png", "1700000000050000000.png"})
    writeFile(folder.filePath(QString("pictures/") + name), huge);
  writeFile(
      folder.filePath("session.yaml"),
      "evical_session: 1\nrecording: pictures\nboard: {type: checkerboard, rows: 6, cols: 7, spacing_m: "
      "0.05}\ncameras:\n  cam: {stream: pictures}\nreference: cam\n");
  const Outcome outcome =
      runProgram({"intrinsics", folder.filePath("session.yaml"), "-o", folder.filePath("out")});
  QVERIFY2(outcome.exit_code == 1 || outcome.exit_code == 2, qPrintable(outcome.errors));
  VERIFY_SAYS(outcome, "frame at 0.000 s: claims a size of .*implausible");
}

EVICAL_TEST(TestBadRecording)
#include "tst_bad_recording.moc"
