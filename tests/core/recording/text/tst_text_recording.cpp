#include "core/base/error.h"
#include "core/recording/text/text_lines.h"
#include "tests/core/recording/sample_recording.h"

#include <QTemporaryDir>
#include <QtTest>

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

 private:
  std::filesystem::path path(const char* name) const { return folder_.filePath(name).toStdString(); }
  QTemporaryDir folder_;
};

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
  const Recording read = readAll(*reader);
  QVERIFY(same(read.events, written.events));
  QVERIFY(same(read.imu_samples, written.imu_samples));
  QVERIFY(reader->faults().empty());
  QCOMPARE(reader->fractionRead(), 1.0);
}

void TestTextRecording::sampleOfOthers_matchesItsSums() {
  const auto reader = openRecording(EVICAL_TEST_DATA "/recordings/evlib_event.txt");
  const Recording read = readAll(*reader);
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
  const Recording read = readAll(*openRecording(path("gyro_first.txt")));
  QCOMPARE(read.imu_samples.size(), 1u);
  QCOMPARE(read.imu_samples[0].time_ns, std::int64_t{1'500'000'000});
  QVERIFY((read.imu_samples[0].angular_rate_rad_s == Eigen::Vector3d(1, 2, 3)));
  QVERIFY((read.imu_samples[0].specific_force_m_s2 == Eigen::Vector3d(4, 5, 6)));
}

void TestTextRecording::badLines_areReportedAndLeftOut() {
  writeFile(path("bad.txt"),
            "0.1 1 2 1\n0.2 1 70000 1\nrubbish\n\n# note\r\n0.3 3 4 -1\r\n0.4 1.0e+01 4 1\n0.5 1");
  const auto reader = openRecording(path("bad.txt"));
  const Recording read = readAll(*reader);
  QCOMPARE(read.events.size(), 3u);
  QVERIFY(!read.events[1].brighter);
  QCOMPARE(int(read.events[2].x_px), 10);
  QCOMPARE(reader->faults().size(), 3u);
  QCOMPARE(reader->faults()[0].kind, std::string("corrupt"));
  QVERIFY(reader->faults()[0].text.starts_with("Line 2 "));
  QCOMPARE(reader->faults()[2].kind, std::string("truncated"));
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

QTEST_GUILESS_MAIN(TestTextRecording)
#include "tst_text_recording.moc"
