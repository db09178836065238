#include "core/base/error.h"
#include "core/recording/text/text_lines.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QProcess>
#include <QTemporaryDir>

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

class TestTextRecording : public QObject {
  Q_OBJECT

 private slots:
  void seconds_areExact_data();
  void seconds_areExact();
  void roundTrip_isExact();
  void sampleOfOthers_matchesItsSums();
  void imuHeader_decidesTheColumns();
  void badLines_areReportedAndLeftOut();
  void stepBack_endsThePacket();
  void writer_refusesTwoCameras();
  void csv_roundTripIsExact();
  void columns_areFound_data();
  void columns_areFound();
  void euroc_hasTheRateFirst();
  void carriageReturns_endLines_data();
  void carriageReturns_endLines();
  void imuUnits_areThoseOfTheHeader();
  void imuWithoutHeader_isToldByGravity();
  void columnsThatMakeNoSense_areRefused();
  void points_areReadByTheirHeader();
  void packedText_isReadAsItIs();
  void packedText_thatIsCut_isToldOf();
  void packedOthers_areRefused();

 private:
  std::filesystem::path path(const char* name) const { return folder_.filePath(name).toStdString(); }
  // Packs what is written; returns the packed file's path.
  std::filesystem::path pack(const char* name, const QByteArray& content) const {
    QFile file(folder_.filePath(name));
    if (!file.open(QIODevice::WriteOnly)) qFatal("%s cannot be written", name);
    file.write(content);
    file.close();
    if (QProcess::execute("gzip", {"-f", file.fileName()}) != 0) qFatal("gzip does not run");
    return path(name).string() + ".gz";
  }
  QTemporaryDir folder_;
};

// More lines than a buffer holds, so that unpacking goes on between them.
QByteArray manyEvents() {
  QByteArray text;
  for (int i = 0; i < 40'000; ++i)
    text += QByteArray::number(1e-5 * i, 'f', 6) + ' ' + QByteArray::number(i % 97) + ' ' +
            QByteArray::number(i * 7 % 89) + (i % 3 == 0 ? " 1\n" : " 0\n");
  return text;
}

std::vector<Event> eventsOf(RecordingReader& reader) {
  std::vector<Event> events;
  for (Packet packet; reader.read(packet);)
    events.insert(events.end(), packet.events.begin(), packet.events.end());
  return events;
}

void TestTextRecording::packedText_isReadAsItIs() {
  const QByteArray text = manyEvents();
  const std::filesystem::path packed = pack("events.csv", "t,x,y,p\n" + text);
  QFile plain(folder_.filePath("plain.csv"));
  QVERIFY(plain.open(QIODevice::WriteOnly));
  plain.write("t,x,y,p\n" + text);
  plain.close();
  const auto reader = openRecording(packed), other = openRecording(path("plain.csv"));
  QCOMPARE(reader->streams().at(0).name, std::string("events.csv.gz"));
  QCOMPARE(reader->format(), std::string("csv"));
  const std::vector<Event> events = eventsOf(*reader);
  QCOMPARE(events.size(), std::size_t{40'000});
  QVERIFY(std::ranges::equal(events, eventsOf(*other), [](const Event& a, const Event& b) {
    return a.time_ns == b.time_ns && a.x_px == b.x_px && a.y_px == b.y_px && a.brighter == b.brighter;
  }));
  QVERIFY(reader->faults().empty());
  QVERIFY(std::abs(reader->fractionRead() - 1.0) < 1e-9);
}

void TestTextRecording::packedText_thatIsCut_isToldOf() {
  const std::filesystem::path packed = pack("cut.csv", "t,x,y,p\n" + manyEvents());
  std::filesystem::resize_file(packed, std::filesystem::file_size(packed) / 2);
  const auto reader = openRecording(packed);
  const std::size_t count = eventsOf(*reader).size();
  QVERIFY2(count > 10'000 && count < 30'000, qPrintable(QString::number(count)));
  QVERIFY(!reader->faults().empty() && reader->faults().back().kind == FaultKind::Truncated);
  QVERIFY(reader->faults().back().text.find("damaged after line ") != std::string::npos);
}

void TestTextRecording::packedOthers_areRefused() {
  const std::filesystem::path packed = pack("data.raw", QByteArray("% evt 3.0\n") + QByteArray(100, '\x01'));
  try {
    openRecording(packed);
    QFAIL("it was opened");
  } catch (const CalibrationError& error) {
    QVERIFY2(std::string(error.what()).find("packed with gzip") != std::string::npos, error.what());
  }
}

// A packet holds what was measured at one time.
void TestTextRecording::points_areReadByTheirHeader() {
  QFile file(QString::fromStdString(path("points.csv").string()));
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write(
      "time_ns,point,x_px,y_px,sigma_px\n1404733405732800000,7,10.25,20.5,0.1\n"
      "1404733405732800000,8,11,21,0.2\nnonsense\n1404733405782800000,7,-0.25,21,0\n");
  file.close();
  const auto reader = openRecording(path("points.csv"));
  QVERIFY(reader->streams().at(0).type == StreamType::Points);
  Packet packet;
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.points.size(), std::size_t{2});
  QCOMPARE(packet.points[0].time_ns, std::int64_t{1404733405732800000});
  QVERIFY(packet.points[0].point == 7 && packet.points[0].x_px == 10.25F && packet.points[0].y_px == 20.5F);
  QCOMPARE(packet.points[1].sigma_px, 0.2F);
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.points.size(), std::size_t{1});
  QCOMPARE(packet.points[0].x_px, -0.25F);
  QVERIFY(!reader->read(packet));
  QVERIFY(!reader->faults().empty() && reader->faults().back().text.find("Line 4") == 0);
}

void TestTextRecording::seconds_areExact_data() {
  QTest::addColumn<QByteArray>("text");
  QTest::addColumn<bool>("good");
  QTest::addColumn<qlonglong>("time_ns");
  const auto row = [](const char* text, bool good, qlonglong time_ns) {
    QTest::newRow(text) << QByteArray(text) << good << time_ns;
  };
  row("1605537493.718345123", true, 1605537493718345123);  // a double would lose the last digits
  row("0.000779999", true, 779999);
  row("12", true, 12'000'000'000);
  row("-0.5", true, -500'000'000);
  row(".25", true, 250'000'000);
  row("0.0000000015", true, 2);
  row("1.605537493718345123e+09", true, 1605537493718345123);
  row("5e-3", true, 5'000'000);
  row("1e12", false, 0);
  row("99999999999.0", false, 0);
  row("", false, 0);
  row("x", false, 0);
  row("1.2.3", false, 0);
  row("nan", false, 0);
  row("1e", false, 0);
  row("4.7e9", false, 0);  // differences of such times would overflow
  row("-4.7e9", false, 0);
  row("1e-2147483648", false, 0);
}

void TestTextRecording::seconds_areExact() {
  QFETCH(QByteArray, text);
  QFETCH(bool, good);
  QFETCH(qlonglong, time_ns);
  std::int64_t parsed_ns = 0;
  QCOMPARE(parseSeconds(text.toStdString(), parsed_ns), good);
  if (good) QCOMPARE(qlonglong(parsed_ns), time_ns);
}

void TestTextRecording::roundTrip_isExact() {
  const Recording written = sampleRecording(50'000);
  std::vector<StreamInfo> streams = sampleStreams();
  writeAll(*createText(folder_.path().toStdString(), streams), written);
  const auto reader = openRecording(folder_.path().toStdString());
  QCOMPARE(reader->format(), std::string("text"));
  QCOMPARE(reader->streams().size(), 2u);
  const Recording read = readRecording(*reader);
  QVERIFY(same(read.events, written.events));
  QVERIFY(same(read.imu_samples, written.imu_samples));
  QVERIFY(reader->faults().empty());
  QCOMPARE(reader->fractionRead(), 1.0);
}

void TestTextRecording::sampleOfOthers_matchesItsSums() {
  const auto reader = openRecording(test::sourcePath("tests/data/recordings/evlib_event.txt"));
  const Recording read = readRecording(*reader);
  int sum_x = 0, sum_y = 0;
  std::int64_t sum_t = 0;
  for (const Event& event : read.events) {
    sum_x += event.x_px;
    sum_y += event.y_px;
    sum_t += event.time_ns;
    QVERIFY(!event.brighter);
  }
  QCOMPARE(read.events.size(), 17u);
  QCOMPARE(sum_x, 1801);
  QCOMPARE(sum_y, 1103);
  QCOMPARE(sum_t, std::int64_t{57'663'991});
}

void TestTextRecording::imuHeader_decidesTheColumns() {
  writeFile(
      path("gyro_first.txt"),
      "# id timestamp ang_vel_x ang_vel_y ang_vel_z lin_acc_x lin_acc_y lin_acc_z\n7 1.5 1 2 3 4 5 6\n");
  const Recording read = readRecording(*openRecording(path("gyro_first.txt")));
  QCOMPARE(read.imu_samples.size(), 1u);
  QCOMPARE(read.imu_samples[0].time_ns, std::int64_t{1'500'000'000});
  QVERIFY((read.imu_samples[0].angular_rate_rad_s == Eigen::Vector3d(1, 2, 3)));
  QVERIFY((read.imu_samples[0].specific_force_m_s2 == Eigen::Vector3d(4, 5, 6)));
}

void TestTextRecording::badLines_areReportedAndLeftOut() {
  writeFile(path("bad.txt"),
            "0.1 1 2 1\n0.2 1 70000 1\nrubbish\n\n# note\r\n0.3 3 4 -1\r\n0.4 1.0e+01 4 1\n0.5 1");
  const auto reader = openRecording(path("bad.txt"));
  const Recording read = readRecording(*reader);
  QCOMPARE(read.events.size(), 3u);
  QVERIFY(!read.events[1].brighter);
  QCOMPARE(int(read.events[2].x_px), 10);
  QCOMPARE(reader->faults().size(), 3u);
  QCOMPARE(reader->faults()[0].kind, FaultKind::Corrupt);
  QVERIFY(reader->faults()[0].text.starts_with("Line 2 "));
  QCOMPARE(reader->faults()[2].kind, FaultKind::Truncated);
}

void TestTextRecording::stepBack_endsThePacket() {
  writeFile(path("back.txt"), "0.001 1 2 1\n0.002 1 2 1\n0.0015 3 4 0\n");
  const auto reader = openRecording(path("back.txt"));
  Packet packet;
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.events.size(), 2u);
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.events.size(), 1u);
  QVERIFY(!reader->read(packet));
}

void TestTextRecording::writer_refusesTwoCameras() {
  QTemporaryDir folder;
  const std::vector<StreamInfo> streams(2, sampleStreams()[0]);
  QVERIFY_EXCEPTION_THROWN(createText(folder.path().toStdString(), streams), CalibrationError);
  QVERIFY(std::filesystem::is_empty(folder.path().toStdString()));
}

void TestTextRecording::csv_roundTripIsExact() {
  QTemporaryDir folder;
  const Recording written = sampleRecording(20'000);
  writeAll(*createRecording(folder.path().toStdString(), "csv", sampleStreams()), written);
  const auto reader = openRecording(folder.path().toStdString());
  QCOMPARE(reader->format(), std::string("csv"));
  const Recording read = readRecording(*reader);
  QVERIFY(same(read.events, written.events));
  QVERIFY(same(read.imu_samples, written.imu_samples));
  QVERIFY(reader->faults().empty());
}

void TestTextRecording::columns_areFound_data() {
  QTest::addColumn<QByteArray>("text");
  QTest::addColumn<qlonglong>("first_ns");
  QTest::addColumn<bool>("guessed");
  const auto row = [](const char* name, const char* text, qlonglong first_ns, bool guessed) {
    QTest::newRow(name) << QByteArray(text) << first_ns << guessed;
  };
  // The same two events each: (300, 200, on), then (301, 7, off).
  row("named, us", "t_us,x,y,p\n5000000,300,200,1\n5000001,301,7,0\n", 5'000'000'000, false);
  row("named, ns, other order", "polarity,y,x,timestamp [ns]\n1,200,300,50\n0,7,301,60\n", 50, false);
  row("named, s", "# x y p t\n300 200 1 0.5\n301 7 0 0.6\n", 500'000'000, false);
  row("named, no unit", "t,x,y,p\n5000000,300,200,1\n5000001,301,7,0\n", 5'000'000'000, true);
  row("named, words", "time(ms);x;y;pol\n12;300;200;True\n13;301;7;False\n", 12'000'000, false);
  row("Metavision with geometry", "%geometry:640,480\n300,200,1,9\n301,7,0,10\n", 9'000, false);
  row("Metavision without", "300,200,1,5000000\n301,7,0,5000009\n", 5'000'000'000, true);
  row("headerless, ns since 1970", "1600000000123456789,300,200,1\n1600000000123456790,301,7,0\n",
      1'600'000'000'123'456'789, true);
  row("headerless, s", "0.25 300 200 1\n0.26 301 7 0\n", 250'000'000, false);
}

void TestTextRecording::columns_areFound() {
  QFETCH(QByteArray, text);
  QFETCH(qlonglong, first_ns);
  QFETCH(bool, guessed);
  writeFile(path("table.csv"), text.toStdString());
  const auto reader = openRecording(path("table.csv"));
  const Recording read = readRecording(*reader);
  QCOMPARE(read.events.size(), 2u);
  QCOMPARE(qlonglong(read.events[0].time_ns), first_ns);
  QCOMPARE(int(read.events[0].x_px), 300);
  QCOMPARE(int(read.events[0].y_px), 200);
  QCOMPARE(int(read.events[1].x_px), 301);
  QCOMPARE(int(read.events[1].y_px), 7);
  QVERIFY(read.events[0].brighter && !read.events[1].brighter);
  QCOMPARE(reader->faults().size(), guessed ? 1u : 0u);
  if (guessed) QCOMPARE(reader->faults()[0].kind, FaultKind::Guess);
  const bool has_geometry = text.startsWith('%');
  QCOMPARE(reader->streams()[0].resolution_px.width_px, has_geometry ? 640 : 0);
}

void TestTextRecording::euroc_hasTheRateFirst() {
  writeFile(path("data.csv"),
            "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
            "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\r\n1403636579758555392,-0.1,0.15,0.03,8.2,-0.4,-3.5\r\n");
  const auto reader = openRecording(path("data.csv"));
  const Recording read = readRecording(*reader);
  QCOMPARE(read.imu_samples.size(), 1u);
  QCOMPARE(read.imu_samples[0].time_ns, std::int64_t{1403636579758555392});
  QVERIFY((read.imu_samples[0].angular_rate_rad_s == Eigen::Vector3d(-0.1, 0.15, 0.03)));
  QVERIFY((read.imu_samples[0].specific_force_m_s2 == Eigen::Vector3d(8.2, -0.4, -3.5)));
  QVERIFY(reader->faults().empty());
}

void TestTextRecording::carriageReturns_endLines_data() {
  QTest::addColumn<QString>("end");
  QTest::newRow("CR") << "\r";
  QTest::newRow("CR LF") << "\r\n";
}

void TestTextRecording::carriageReturns_endLines() {
  QFETCH(QString, end);
  const std::string line_end = end.toStdString();
  std::string events, samples = "#timestamp [ns],wx,wy,wz,ax,ay,az" + line_end;
  for (int i = 0; i < 8000; ++i) events += "0." + std::to_string(100'000 + i) + " 7 9 1" + line_end;
  for (int i = 0; i < 100; ++i) samples += std::to_string(1'000'000 * i) + ",1,2,3,0.1,0.2,9.8" + line_end;
  writeFile(path("cr_events.txt"), events);
  writeFile(path("cr_imu.csv"), samples);
  const auto events_reader = openRecording(path("cr_events.txt")),
             imu_reader = openRecording(path("cr_imu.csv"));
  QCOMPARE(readRecording(*events_reader).events.size(), std::size_t{8000});
  QCOMPARE(readRecording(*imu_reader).imu_samples.size(), std::size_t{100});
  QVERIFY(events_reader->faults().empty() && imu_reader->faults().empty());
}

void TestTextRecording::imuUnits_areThoseOfTheHeader() {
  writeFile(
      path("units.csv"),
      "time_us,acc_x [g],acc_y [g],acc_z [g],gyro_x [deg/s],gyro_y [deg/s],gyro_z [deg/s]\n7,0,0,1,1,2,3\n");
  const auto reader = openRecording(path("units.csv"));
  QVERIFY(reader->streams()[0].acceleration_unit == AccelerationUnit::Gravity);
  QVERIFY(reader->streams()[0].angular_rate_unit == AngularRateUnit::DegreesPerSecond);
  QCOMPARE(reader->streams()[0].time_unit_ns, std::int64_t{1000});
  QCOMPARE(readRecording(*reader).imu_samples.at(0).time_ns, std::int64_t{7000});
}

void TestTextRecording::imuWithoutHeader_isToldByGravity() {
  writeFile(path("imu7.csv"), "0.001,1,2,3,0.1,9.8,0.2\n0.002,1,2,3,0.1,9.8,0.2\n");
  const auto reader = openRecording(path("imu7.csv"));
  const Recording read = readRecording(*reader);
  QVERIFY((read.imu_samples.at(1).angular_rate_rad_s == Eigen::Vector3d(1, 2, 3)));
  QCOMPARE(reader->faults().at(0).kind, FaultKind::Guess);
}

void TestTextRecording::columnsThatMakeNoSense_areRefused() {
  for (const char* text : {"1,2,3\n4,5,6\n", "9,5,7,8\n3,9,2,1\n", ",,,\n", "\n\n", "a,b,c,d\n9,5,7,8\n"}) {
    writeFile(path("odd.csv"), text);
    QVERIFY_EXCEPTION_THROWN(openRecording(path("odd.csv")), CalibrationError);
  }
}

EVICAL_TEST(TestTextRecording)
#include "tst_text_recording.moc"
