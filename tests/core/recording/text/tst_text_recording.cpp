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
  void manyBadLines_areCounted_data();
  void manyBadLines_areCounted();
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
  void imuColumns_areToldByName_data();
  void imuColumns_areToldByName();
  void eventColumns_areToldByName_data();
  void eventColumns_areToldByName();
  void namesThatDoNotTell_areRefused_data();
  void namesThatDoNotTell_areRefused();
  void sessionsColumns_countInstead();
  void doubtfulUnitOfTime_isSaid();
  void packedText_isReadAsItIs();
  void packedText_thatIsCut_isToldOf();
  void packedOthers_areRefused();

 private:
  std::filesystem::path path(const char* name) const { return folder_.filePath(name).toStdString(); }
  // Compresses the written file; returns the compressed file's path.
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

// More lines than a buffer can store, so that decompression continues between them.
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

// A packet has the measurements of one time.
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

void TestTextRecording::manyBadLines_areCounted_data() {
  QTest::addColumn<QByteArray>("header");
  QTest::addColumn<QByteArray>("row");
  QTest::newRow("IMU") << QByteArray("t_s,ax,ay,az,gx,gy,gz\n") << QByteArray("0.1,1,2,9.8,1,2,3\n");
  QTest::newRow("events") << QByteArray("t_s,x,y,p\n") << QByteArray("0.1,1,2,1\n");
  QTest::newRow("points") << QByteArray("t_s,point,x_px,y_px\n") << QByteArray("0.1,1,2,3\n");
}

void TestTextRecording::manyBadLines_areCounted() {
  QFETCH(QByteArray, header);
  QFETCH(QByteArray, row);
  for (const int bad : {10, 11, 250}) {
    QByteArray text = header + row + row;
    for (int i = 0; i < bad; ++i) text += "rubbish\n";
    writeFile(path("many_bad.csv"), (text + row).toStdString());
    const auto reader = openRecording(path("many_bad.csv"));
    readRecording(*reader);
    QCOMPARE(reader->faults().size(), bad == 10 ? 10u : 11u);
    if (bad == 10) continue;
    const std::string more =
        bad == 11 ? "1 more line is left out; 11 in all." : "240 more lines are left out; 250 in all.";
    QCOMPARE(reader->faults().back().text, more);
    QVERIFY(reader->faults().back().kind == FaultKind::Corrupt);
  }
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
  QVERIFY_THROWS_EXCEPTION(CalibrationError, createText(folder.path().toStdString(), streams));
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
    QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(path("odd.csv")));
  }
}

// Each table has one sample: acceleration (1, 2, 9.5) m/s^2, rate (0.1, 0.2, 0.3) rad/s.
void TestTextRecording::imuColumns_areToldByName_data() {
  QTest::addColumn<QByteArray>("header");
  QTest::addColumn<QByteArray>("row");
  QTest::addColumn<qlonglong>("time_ns");
  const auto row = [](const char* name, const char* header, const char* values, qlonglong time_ns) {
    QTest::newRow(name) << QByteArray(header) << QByteArray(values) << time_ns;
  };
  row("axes in another order", "timestamp_ns,gyro_z,gyro_y,gyro_x,acc_z,acc_y,acc_x", "7,0.3,0.2,0.1,9.5,2,1",
      7);
  row("axes mixed", "t_us,ay,gx,az,gy,ax,gz", "7,2,0.1,9.5,0.2,1,0.3", 7000);
  row("a stranger between", "timestamp_ns,accuracy,ax,ay,az,gx,gy,gz", "7,3,1,2,9.5,0.1,0.2,0.3", 7);
  row("covariances",
      "stamp_ns,angular_velocity.x,angular_velocity.y,angular_velocity.z,angular_velocity_covariance0,"
      "linear_acceleration.x,linear_acceleration.y,linear_acceleration.z,linear_acceleration_covariance0",
      "7,0.1,0.2,0.3,5,1,2,9.5,6", 7);
  row("VectorNav", "TimeStartup,UncompGyroX,UncompGyroY,UncompGyroZ,UncompAccX,UncompAccY,UncompAccZ",
      "7,0.1,0.2,0.3,1,2,9.5", 7);
  row("rate and specific force", "t_s,RateX,RateY,RateZ,FX,FY,FZ", "0.5,0.1,0.2,0.3,1,2,9.5", 500'000'000);
  row("PX4",
      "timestamp [us],gyro_rad[0],gyro_rad[1],gyro_rad[2],gyro_integral_dt,accelerometer_timestamp_relative,"
      "accelerometer_m_s2[0],accelerometer_m_s2[1],accelerometer_m_s2[2],accelerometer_integral_dt",
      "7,0.1,0.2,0.3,5000,0,1,2,9.5,5000", 7000);
  row("MAVLink", "time_us,xacc,yacc,zacc,xgyro,ygyro,zgyro,xmag,ymag,zmag", "7,1,2,9.5,0.1,0.2,0.3,4,5,6",
      7000);
  row("numbered from 1", "t_us,acc1,acc2,acc3,gyr1,gyr2,gyr3", "7,1,2,9.5,0.1,0.2,0.3", 7000);
  row("seconds and nanoseconds", "stamp_secs,stamp_nsecs,gyro_x,gyro_y,gyro_z,acc_x,acc_y,acc_z",
      "1700000000,5,0.1,0.2,0.3,1,2,9.5", 1'700'000'000'000'000'005);
  row("ROS 2's parts", "header.stamp.sec,header.stamp.nanosec,gx,gy,gz,ax,ay,az", "3,7,0.1,0.2,0.3,1,2,9.5",
      3'000'000'007);
  row("the header's stamp before the bag's",
      "%time,field.header.stamp,field.header.frame_id,field.angular_velocity.x,"
      "field.angular_velocity.y,field.angular_velocity.z,field.linear_acceleration.x,field.linear_"
      "acceleration.y,"
      "field.linear_acceleration.z",
      "1700000000000000300,1700000000000000007,imu,0.1,0.2,0.3,1,2,9.5", 1'700'000'000'000'000'007);
  row("dates", "time,ax,ay,az,gx,gy,gz", "2026-03-01T10:00:00.25Z,1,2,9.5,0.1,0.2,0.3",
      1'772'359'200'250'000'000);
  row("dates of another zone", "time,ax,ay,az,gx,gy,gz", "2026-03-01 11:30:00.25+01:30,1,2,9.5,0.1,0.2,0.3",
      1'772'359'200'250'000'000);
  row("decimal commas", "t_s;ax;ay;az;gx;gy;gz", "0,5;1,0;2,0;9,5;0,1;0,2;0,3", 500'000'000);
  row("decimal commas and tabs", "t_s\tax\tay\taz\tgx\tgy\tgz", "0,5\t1\t2\t9,5\t0,1\t0,2\t0,3", 500'000'000);
  row("comments above",
      "// Start Time: Unknown\n// Sample rate: "
      "200.0Hz\nPacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z",
      "0,7,1,2,9.5,0.1,0.2,0.3", 700'000);
  row("byte order mark and sep", "\xEF\xBB\xBFsep=;\nt_us;ax;ay;az;gx;gy;gz", "7;1;2;9.5;0.1;0.2;0.3", 7000);
  row("quoted, and an index", "\"\",\"t_us\",\"ax\",\"ay\",\"az\",\"gx\",\"gy\",\"gz\"",
      "0,7,1,2,9.5,0.1,0.2,0.3", 7000);
  row("units apart from names", "# t [us] ax [m/s^2] ay [m/s^2] az [m/s^2] gx [rad/s] gy [rad/s] gz [rad/s]",
      "7 1 2 9.5 0.1 0.2 0.3", 7000);
  row("Latin-1", "t [\xB5s],ax [m/s\xB2],ay [m/s\xB2],az [m/s\xB2],gx [\xB0/s],gy [\xB0/s],gz [\xB0/s]",
      "7,1,2,9.5,5.729577951308232,11.459155902616464,17.188733853924695", 7000);
  row("milli-g and deg/s", "t_us,ax_mg,ay_mg,az_mg,gx_dps,gy_dps,gz_dps",
      "7,101.97162129779282,203.94324259558565,968.7304023290318,5.729577951308232,11.459155902616464,17."
      "188733853924695",
      7000);
}

void TestTextRecording::imuColumns_areToldByName() {
  QFETCH(QByteArray, header);
  QFETCH(QByteArray, row);
  QFETCH(qlonglong, time_ns);
  writeFile(path("named.csv"), (header + "\n" + row + "\n").toStdString());
  const auto reader = openRecording(path("named.csv"));
  const Recording read = readRecording(*reader);
  QCOMPARE(read.imu_samples.size(), std::size_t{1});
  const ImuSample& sample = read.imu_samples[0];
  QCOMPARE(qlonglong(sample.time_ns), time_ns);
  QVERIFY((sample.specific_force_m_s2 - Eigen::Vector3d(1.0, 2.0, 9.5)).norm() < 1e-9);
  QVERIFY((sample.angular_rate_rad_s - Eigen::Vector3d(0.1, 0.2, 0.3)).norm() < 1e-9);
}

// The same two events each: (300, 200, on) at 5 us, then (301, 7, off).
void TestTextRecording::eventColumns_areToldByName_data() {
  QTest::addColumn<QByteArray>("text");
  const auto row = [](const char* name, const char* text) { QTest::newRow(name) << QByteArray(text); };
  row("extra columns", "x,y,x_flow,t_us,confidence,p\n300,200,0.5,5,1,1\n301,7,0.5,6,1,0\n");
  row("types of OpenMV", "type,sec,ms,us,x,y\n1,0,0,5,300,200\n2,0,0,5,0,0\n0,0,0,6,301,7\n4,0,0,9,0,0\n");
  row("words", "event_type;pos_x;pos_y;time [us]\n1;300;200;5\n0;301;7;6\n");
  row("text next to numbers", "t_us,source,x,y,pol\n5,left,300,200,1\n6,left,301,7,-1\n");
}

void TestTextRecording::eventColumns_areToldByName() {
  QFETCH(QByteArray, text);
  writeFile(path("events_named.csv"), text.toStdString());
  const auto reader = openRecording(path("events_named.csv"));
  const Recording read = readRecording(*reader);
  QCOMPARE(read.events.size(), std::size_t{2});
  QVERIFY(read.events[0].time_ns == 5000 && read.events[0].x_px == 300 && read.events[0].y_px == 200);
  QVERIFY(read.events[0].brighter && !read.events[1].brighter && read.events[1].x_px == 301);
  const bool has_triggers = text.startsWith("type");
  QCOMPARE(reader->faults().size(), has_triggers ? std::size_t{1} : std::size_t{0});
  if (has_triggers) QVERIFY(reader->faults()[0].text.starts_with("2 lines are left out"));
}

void TestTextRecording::namesThatDoNotTell_areRefused_data() {
  QTest::addColumn<QByteArray>("text");
  QTest::addColumn<QByteArray>("problem");
  QTest::addColumn<QByteArray>("line");
  const auto row = [](const char* name, const char* text, const char* problem, const char* line) {
    QTest::newRow(name) << QByteArray(text) << QByteArray(problem) << QByteArray(line);
  };
  row("no gyroscope", "t_us,ax,ay,az,b1,b2,b3\n7,1,2,9.5,1,2,3\n", "no gyroscope", "t_us,ax,ay,az,?,?,?");
  row("no times", "n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z\n0,1,2,3,0.1,0.2,9.8\n1,1,2,3,0.1,0.2,9.8\n",
      "no column of times", nullptr);
  row("two accelerometers",
      "t_us,low_acc_x,low_acc_y,low_acc_z,high_acc_x,high_acc_y,high_acc_z,gx,gy,gz\n7,1,2,9,1,2,9,1,2,3\n",
      "more than one accelerometer: low_acc_x, high_acc_x", "t_us,ax,ay,az,-,-,-,gx,gy,gz");
  row("an axis twice", "t_us,ax,ax,az,gx,gy,gz\n7,1,2,9.5,1,2,3\n",
      "three columns x, y and z of the accelerometer", "");
  row("an unknown unit", "t_us,ax [lsb],ay [lsb],az [lsb],gx,gy,gz\n7,1,2,9.5,1,2,3\n", "meter: lsb", "");
  row("different units", "t_us,ax [g],ay [g],az [mg],gx,gy,gz\n7,1,2,9.5,1,2,3\n", "different units", "");
  row("a name too few", "t_us,ax,ay,az,gx,gy\n7,1,2,9.5,1,2,3\n", "6 names, but its lines have 7", "");
  row("no polarity", "t_us,x,y,z\n7,1,2,9\n", "neither polarity (events) nor point", "t_us,gx,gy,gz");
  row("no header, no gravity", "0.001,1,2,3,0.1,5.8,0.2\n0.002,1,2,3,0.1,5.8,0.2\n", "numbers do not show",
      "t_s,ax,ay,az,gx,gy,gz");
}

void TestTextRecording::namesThatDoNotTell_areRefused() {
  QFETCH(QByteArray, text);
  QFETCH(QByteArray, problem);
  QFETCH(QByteArray, line);
  writeFile(path("unclear.csv"), text.toStdString());
  try {
    openRecording(path("unclear.csv"));
    QFAIL("it was opened");
  } catch (const CalibrationError& error) {
    QVERIFY2(QByteArray(error.what()).contains(problem), error.what());
    if (!line.isNull()) QVERIFY2(QByteArray(error.what()).contains("columns: \"" + line), error.what());
  }
}

void TestTextRecording::sessionsColumns_countInstead() {
  writeFile(path("wrong.csv"), "t_us,ax,ay,az,gx,gy,gz\n7,0.1,0.2,0.3,2,1,9.5\n");
  const auto reader = openRecording(path("wrong.csv"), {{"wrong.csv", "t_ms,gx,gy,gz,ay,ax,az"}});
  const Recording read = readRecording(*reader);
  QCOMPARE(read.imu_samples.size(), std::size_t{1});
  QCOMPARE(qlonglong(read.imu_samples[0].time_ns), qlonglong(7'000'000));
  QVERIFY((read.imu_samples[0].specific_force_m_s2 == Eigen::Vector3d(1, 2, 9.5)));
  QVERIFY((read.imu_samples[0].angular_rate_rad_s == Eigen::Vector3d(0.1, 0.2, 0.3)));
  writeFile(path("no_text.npy"), "\x93NUMPY");
  QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(path("no_text.npy"), {{"events", "t,x,y,p"}}));
}

void TestTextRecording::doubtfulUnitOfTime_isSaid() {
  std::string text = "t_us,ax,ay,az,gx,gy,gz\n";  // which are ms
  for (int i = 0; i < 50; ++i) text += std::to_string(5 * i) + ",0,0,9.8,1,2,3\n";
  writeFile(path("ms.csv"), text);
  const auto reader = openRecording(path("ms.csv"));
  QCOMPARE(reader->faults().size(), std::size_t{1});
  QVERIFY2(reader->faults()[0].text.find("ms would give 200") != std::string::npos,
           reader->faults()[0].text.c_str());
}

EVICAL_TEST(TestTextRecording)
#include "tst_text_recording.moc"
