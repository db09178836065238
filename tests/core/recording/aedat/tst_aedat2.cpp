// AEDAT 2.0: addresses of each chip, interleaved IMU samples, times that wrap, and nine real recordings.
#include "core/base/error.h"
#include "core/numerics/angles.h"
#include "tests/core/recording/aedat/aedat2_builder.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

using namespace evical;
using namespace evical::test;

class TestAedat2 : public QObject {
  Q_OBJECT

 private slots:
  void dvs128_isDecoded_data();
  void dvs128_isDecoded();
  void davis_isDecoded_data();
  void davis_isDecoded();
  void unnamedDavis_isGuessedBySize();
  void imuSamples_standBetweenTheEvents();
  void rangesOfTheImu_areThoseThatGravitySupports();
  void brokenImuSamples_areLeftOut();
  void pixelValuesAndEdges_areNoEvents();
  void pixelValues_makeFrames();
  void rollingShutter_isToldOf();
  void partsOfFrames_areLeftOut();
  void time_goesOnWhereItsCounterWraps();
  void headerEndsAtItsMark_andAtBytesThatAreNoText();
  void otherChips_areRefusedByName();
  void everyCut_keepsWhatIsWhole();
  void damageAnywhere_neverCrashes();
  void realRecordings_matchAnotherDecoder_data();
  void realRecordings_matchAnotherDecoder();

 private:
  Contents read(const std::string& bytes) const { return readAll(scratch_.write("file.aedat", bytes)); }
  ScratchFolder scratch_;
};

void TestAedat2::dvs128_isDecoded_data() {
  QTest::addColumn<QString>("chip");
  QTest::newRow("named") << "DVS128";
  QTest::newRow("not named") << "";
}

void TestAedat2::dvs128_isDecoded() {
  QFETCH(QString, chip);
  const std::vector<Event> events = someEvents(100'000, 5'000'000);
  std::string bytes = aedat2Header(chip.toStdString());
  for (const Event& event : events)
    bytes += aedat2Record(dvs128Address(event), static_cast<std::int32_t>(event.time_ns / 1000));
  const Contents contents = read(bytes);
  QVERIFY(sameEvents(contents.events.at(0), events));
  QCOMPARE(contents.streams[0].resolution_px.width_px, 128);
  QCOMPARE(contents.hasFault(FaultKind::Guess), chip.isEmpty());
}

void TestAedat2::davis_isDecoded_data() {
  QTest::addColumn<QString>("chip");
  QTest::addColumn<int>("width");
  QTest::addColumn<int>("height");
  QTest::newRow("DAVIS240C") << "DAVIS240C" << 240 << 180;
  QTest::newRow("Davis346blue") << "Davis346blue" << 346 << 260;
  QTest::newRow("Davis640") << "Davis640" << 640 << 480;
}

void TestAedat2::davis_isDecoded() {
  QFETCH(QString, chip);
  QFETCH(int, width);
  QFETCH(int, height);
  std::vector<Event> events = someEvents(1000, 5'000'000);
  events[7].x_px = static_cast<std::uint16_t>(width - 1);
  events[7].y_px = static_cast<std::uint16_t>(height - 1);
  std::string bytes = aedat2Header(chip.toStdString());
  for (const Event& event : events)
    bytes +=
        aedat2Record(davisAddress(event, width, height), static_cast<std::int32_t>(event.time_ns / 1000));
  const Contents contents = read(bytes);
  QVERIFY(sameEvents(contents.events.at(0), events));
  QCOMPARE(contents.streams[0].resolution_px.width_px, width);
  QCOMPARE(contents.streams[0].resolution_px.height_px, height);
  QVERIFY(contents.faults.empty());
}

void TestAedat2::unnamedDavis_isGuessedBySize() {
  std::vector<Event> events = someEvents(1000, 5'000'000);
  events[3].x_px = 0;  // the largest address
  events[4].y_px = 0;
  std::string bytes = aedat2Header("");
  for (const Event& event : events)
    bytes += aedat2Record(davisAddress(event, 346, 260), static_cast<std::int32_t>(event.time_ns / 1000));
  const Contents contents = read(bytes);
  QVERIFY(sameEvents(contents.events.at(0), events));
  QVERIFY(contents.hasFault(FaultKind::Guess));
}

void TestAedat2::imuSamples_standBetweenTheEvents() {
  std::string bytes = aedat2Header("DAVIS240C");
  const std::vector<Event> events = someEvents(10, 5'000'000);
  for (const Event& event : events) {
    const auto time_us = static_cast<std::int32_t>(event.time_ns / 1000);
    bytes += aedat2Record(davisAddress(event, 240, 180), time_us);
    bytes += aedat2Imu({8192, -4096, 0, 77, 655, -1310, -32768}, time_us);
  }
  const auto reader = openRecording(scratch_.write("imu.aedat", bytes));
  QCOMPARE(reader->streams().size(), std::size_t{3});
  std::vector<RawImuSample> samples;
  std::vector<Event> seen;
  Packet packet;
  while (reader->read(packet)) {
    samples.insert(samples.end(), packet.imu_samples.begin(), packet.imu_samples.end());
    seen.insert(seen.end(), packet.events.begin(), packet.events.end());
    QVERIFY(reader->streams()[packet.stream].type ==
            (packet.events.empty() ? StreamType::Imu : StreamType::Events));
  }
  QVERIFY(sameEvents(seen, events));
  QCOMPARE(samples.size(), std::size_t{10});
  QCOMPARE(samples[3].time_ns, events[3].time_ns);
  QVERIFY(samples[3].specific_force == Eigen::Vector3d(1.0, -0.5, 0.0));                   // g
  QVERIFY(samples[3].angular_rate.isApprox(Eigen::Vector3d(10.0, -20.0, -32768 / 65.5)));  // deg/s
  const auto only_imu = openRecording(scratch_ / "imu.aedat");
  only_imu->select({1});
  const Contents contents = readAll(*only_imu);
  QCOMPARE(contents.eventCount(), 0u);
  QCOMPARE(contents.sampleCount(), 10u);
}

// jAER sets 8 g and 1000 deg/s for some: with the default ranges gravity would be 0.50 g.
void TestAedat2::rangesOfTheImu_areThoseThatGravitySupports() {
  for (const double ranges : {1.0, 2.0}) {
    std::string bytes = aedat2Header("DAVIS240C");
    for (int k = 0; k < 100; ++k) {
      const auto one_g = static_cast<std::int16_t>(8192 / ranges),
                 rate = static_cast<std::int16_t>(655 / ranges);
      bytes += aedat2Imu({0, static_cast<std::int16_t>(10 * (k % 3) - one_g), 20, 77, rate, 0,
                          static_cast<std::int16_t>(-rate)},
                         1000 * k);
    }
    const Contents contents = readAll(scratch_.write("ranges.aedat", bytes));
    const ImuSample& sample = contents.imu.begin()->second.at(50);
    QVERIFY2(std::abs(sample.specific_force_m_s2.norm() / kStandardGravity_m_s2 - 1.0) < 0.01,
             qPrintable(QString::number(sample.specific_force_m_s2.norm())));
    QVERIFY(std::abs(kDegPerRad * sample.angular_rate_rad_s.x() - 10.0) < 0.1);
    QVERIFY(std::any_of(contents.faults.begin(), contents.faults.end(), [&](const RecordingFault& fault) {
      return fault.text.find(ranges == 1.0 ? "4 g and 500 deg/s" : "8 g and 1000 deg/s") != std::string::npos;
    }));
  }
}

void TestAedat2::brokenImuSamples_areLeftOut() {
  const std::string sample = aedat2Imu({1, 2, 3, 4, 5, 6, 7}, 5000);
  const std::string bytes =
      aedat2Header("DAVIS240C") + sample + sample.substr(0, 24) + sample + sample.substr(16);
  const Contents contents = read(bytes);
  QCOMPARE(contents.sampleCount(), 2u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestAedat2::pixelValuesAndEdges_areNoEvents() {
  const Event event{5'000'000, 3, 4, true};
  const std::uint32_t address = davisAddress(event, 240, 180);
  const std::string bytes = aedat2Header("DAVIS240C") + aedat2Record(address, 5000) +
                            aedat2Record(0x8000'0000U | 17, 5001) + aedat2Record(0x8000'0400U | 17, 5002) +
                            aedat2Record(0x400, 5003);
  const Contents contents = read(bytes);
  QVERIFY(sameEvents(contents.events.at(0), {event}));
  QVERIFY(contents.hasFault(FaultKind::ExposureLeftOut));
  QCOMPARE(contents.streams.back().messages, std::uint64_t{1});
  const Contents edge = read(aedat2Header("DVS128") + aedat2Record(0x8000, 5000) + aedat2Record(0, 5000));
  QCOMPARE(edge.eventCount(), 1u);
  QCOMPARE(edge.streams[1].messages, std::uint64_t{1});
}

namespace {

constexpr int kWidth = 208, kHeight = 192;  // of the smallest sensor with frames
constexpr std::int32_t kReadOut_us = 1000, kExposure_us = 5000;

int brightnessAt(int x_px, int y_px) {
  return 3 * x_px + y_px;  // 812 at most
}

std::string apsColumn(int x_px, bool after_exposure, std::int32_t time_us) {
  std::string bytes;
  for (int y = 0; y < kHeight; ++y) {
    const int value = 900 - (after_exposure ? brightnessAt(x_px, y) : 0);
    bytes += aedat2Record(apsAddress(x_px, y, after_exposure, value, kHeight), time_us);
  }
  return bytes;
}

std::string readOut(bool after_exposure, std::int32_t begin_us) {
  std::string bytes;
  for (int x = kWidth - 1, k = 0; x >= 0; --x, ++k)
    bytes += apsColumn(x, after_exposure, begin_us + kReadOut_us * k / (kWidth - 1));
  return bytes;
}

std::string globalFrame(std::int32_t begin_us) {
  return readOut(false, begin_us) + readOut(true, begin_us + kReadOut_us + kExposure_us);
}

std::vector<Frame> framesOf(RecordingReader& reader) {
  reader.select({reader.streams().size() - 2});  // before the triggers
  std::vector<Frame> frames;
  for (Packet packet; reader.read(packet);)
    frames.insert(frames.end(), packet.frames.begin(), packet.frames.end());
  return frames;
}

}  // namespace

void TestAedat2::pixelValues_makeFrames() {
  const Event event{5'000'000, 3, 4, true};
  const auto reader = openRecording(scratch_.write(
      "frames.aedat", aedat2Header("DAVIS208") + globalFrame(5000) +
                          aedat2Record(davisAddress(event, kWidth, kHeight), 15'000) + globalFrame(45'000)));
  QCOMPARE(reader->streams().at(1).name, std::string("frames"));
  QVERIFY(reader->streams().at(1).type == StreamType::Frames);
  const std::vector<Frame> frames = framesOf(*reader);
  QCOMPARE(frames.size(), std::size_t{2});
  QVERIFY(reader->faults().empty());
  QVERIFY(frames[0].format == FrameFormat::Gray16 && !frames[0].big_endian);
  QCOMPARE(frames[0].row_bytes, std::size_t{2 * kWidth});
  QCOMPARE(frames[0].time_ns, std::int64_t{1000} * (5000 + kReadOut_us + kExposure_us / 2));
  QCOMPARE(frames[1].time_ns - frames[0].time_ns, std::int64_t{40'000'000});
  QCOMPARE(frames[0].exposure_s, 1e-6 * kExposure_us);
  for (const auto& [x, y] : {std::pair(0, 0), {kWidth - 1, 0}, {0, kHeight - 1}, {17, 101}}) {
    const std::size_t at = std::size_t(y) * frames[0].row_bytes + 2 * std::size_t(x);
    const int value = frames[0].bytes[at] + 256 * frames[0].bytes[at + 1];
    QCOMPARE(value, 64 * brightnessAt(x, y));
  }
}

// Each column's exposure is read while later columns are still reset.
void TestAedat2::rollingShutter_isToldOf() {
  std::string bytes = aedat2Header("DAVIS208");
  constexpr int kBehind = 100;
  constexpr std::int32_t kColumn_us = 10;
  for (int k = 0; k < kWidth + kBehind; ++k) {
    if (k < kWidth) bytes += apsColumn(kWidth - 1 - k, false, kColumn_us * k);
    if (k >= kBehind) bytes += apsColumn(kWidth - 1 - (k - kBehind), true, kColumn_us * k);
  }
  const auto reader = openRecording(scratch_.write("rolling.aedat", bytes));
  const std::vector<Frame> frames = framesOf(*reader);
  QCOMPARE(frames.size(), std::size_t{1});
  QVERIFY(std::abs(frames[0].exposure_s - 1e-6 * kColumn_us * kBehind) < 1e-9);
  const double middle_us = 0.5 * kColumn_us * (kWidth - 1 + kBehind);
  QVERIFY(std::abs(1e-3 * static_cast<double>(frames[0].time_ns) - middle_us) < 1.0);
  QCOMPARE(reader->faults().size(), std::size_t{1});
  QVERIFY(reader->faults()[0].kind == FaultKind::Metadata && reader->faults()[0].stream == "frames");
}

// A recording starts and ends anywhere; only the lost data in between are missing.
void TestAedat2::partsOfFrames_areLeftOut() {
  const std::string frame = globalFrame(5000), header = aedat2Header("DAVIS208");
  for (const std::string& bytes : {frame.substr(8000) + frame, frame.substr(0, frame.size() - 8) + frame,
                                   frame + frame.substr(0, 8000)}) {
    const auto reader = openRecording(scratch_.write("parts.aedat", header + bytes));
    QCOMPARE(framesOf(*reader).size(), std::size_t{1});
    QCOMPARE(reader->faults().size(), std::size_t{1});
    QVERIFY(reader->faults()[0].kind == FaultKind::ExposureLeftOut);
  }
}

void TestAedat2::time_goesOnWhereItsCounterWraps() {
  constexpr std::int32_t kLast = INT32_MAX, kFirst = INT32_MIN;
  std::string bytes = aedat2Header("DVS128");
  for (const std::int32_t time_us : {kLast - 1, kLast, kFirst, kLast, kFirst + 5})
    bytes += aedat2Record(0, time_us);
  const Contents contents = read(bytes);
  const std::int64_t last_ns = std::int64_t{kLast} * 1000;
  QCOMPARE(contents.eventCount(), 5u);
  const std::vector<Event>& events = contents.events.at(0);  // a late event is sorted in
  QCOMPARE(events[0].time_ns, last_ns - 1000);
  QCOMPARE(events[1].time_ns, last_ns);
  QCOMPARE(events[2].time_ns, last_ns);
  QCOMPARE(events[3].time_ns, last_ns + 1000);
  QCOMPARE(events[4].time_ns, last_ns + 6000);
  QVERIFY(contents.hasFault(FaultKind::TimeWrap));
}

// An event whose address begins with '#', which is a valid byte.
void TestAedat2::headerEndsAtItsMark_andAtBytesThatAreNoText() {
  const std::string event = aedat2Record(0x2300'0000U, 5000);
  QCOMPARE(read(aedat2Header("Davis640") + event).eventCount(), 1u);
  const std::string like_text = aedat2Record(0x2320'2020U, 0x2020'200A);  // except for its kind
  QCOMPARE(read(aedat2Header("Davis640") + "#End Of ASCII Header\r\n" + like_text).eventCount(), 1u);
}

void TestAedat2::otherChips_areRefusedByName() {
  try {
    openRecording(scratch_.write("other.aedat", aedat2Header("CochleaAMS1c") + aedat2Record(0, 0)));
    QFAIL("opened");
  } catch (const CalibrationError& error) {
    QVERIFY(error.problem().find("CochleaAMS1c") != std::string::npos);
  }
  QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(scratch_.write("old.aedat", "#!AER-DAT1.0\r\n")));
}

void TestAedat2::everyCut_keepsWhatIsWhole() {
  std::string bytes = aedat2Header("DVS128");
  const std::size_t header = bytes.size();
  for (const Event& event : someEvents(6, 5'000'000))
    bytes += aedat2Record(dvs128Address(event), static_cast<std::int32_t>(event.time_ns / 1000));
  for (std::size_t size = header; size <= bytes.size(); ++size) {
    const Contents contents = read(bytes.substr(0, size));
    QCOMPARE(contents.eventCount(), (size - header) / 8);
    QCOMPARE(contents.hasFault(FaultKind::Truncated), (size - header) % 8 != 0);
  }
}

void TestAedat2::damageAnywhere_neverCrashes() {
  std::string bytes = aedat2Header("DAVIS240C");
  for (const Event& event : someEvents(6, 5'000'000))
    bytes += aedat2Record(davisAddress(event, 240, 180), 5000) + aedat2Imu({1, 2, 3, 4, 5, 6, 7}, 5000);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const char value : {'\0', '\xFF', '#', '\n'}) {
      std::string damaged = bytes;
      damaged[at] = value;
      try {
        read(damaged);
      } catch (const CalibrationError&) {
        // Bad files cause this error.
      }
    }
  }
}

// Counts and sums from a decoder of ten lines in another language.
void TestAedat2::realRecordings_matchAnotherDecoder_data() {
  QTest::addColumn<QString>("number");
  QTest::addColumn<quint64>("events");
  QTest::addColumn<quint64>("on");
  QTest::addColumn<quint64>("sum_x");
  QTest::addColumn<quint64>("sum_y");
  QTest::addColumn<qint64>("first_us");
  QTest::addColumn<qint64>("last_us");
  const auto row = [](const char* number, quint64 events, quint64 off, quint64 sum_x, quint64 sum_y,
                      qint64 first_us, qint64 last_us) {
    QTest::newRow(number) << number << events << events - off << sum_x << sum_y << first_us << last_us;
  };
  row("12", 327642, 97469, 18207070, 25854200, 242136950, 242691432);
  row("2", 263463, 78898, 14061023, 19522884, 164420655, 164991518);
  row("20", 403422, 128219, 22320897, 27213177, 324110300, 324674149);
  row("22", 106922, 34080, 5844127, 8483789, 345475839, 346042704);
  row("23", 76732, 23560, 3610567, 6578598, 359009566, 359578148);
  row("24", 107425, 33182, 3765567, 11619884, 368588845, 369165689);
  row("25", 210395, 71638, 17832314, 5426320, 376995900, 377569453);
  row("27", 190610, 66416, 16125342, 20119101, 391778226, 392338472);
  row("9", 382942, 126257, 21673195, 24651888, 223594560, 224153431);
}

void TestAedat2::realRecordings_matchAnotherDecoder() {
  const QString folder = qEnvironmentVariable("EVICAL_DATA");
  if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
  QFETCH(QString, number);
  const QString path = QString("%1/real/dvs128_blinking/calibration_%2.aedat").arg(folder, number);
  if (!std::filesystem::exists(path.toStdString())) QSKIP("the recordings are missing");
  const Contents contents = readAll(std::filesystem::path(path.toStdString()));
  const std::vector<Event>& events = contents.events.at(0);
  quint64 on = 0, sum_x = 0, sum_y = 0;
  for (const Event& event : events) {
    on += event.brighter ? 1 : 0;
    sum_x += event.x_px;
    sum_y += event.y_px;
  }
  QTEST(static_cast<quint64>(events.size()), "events");
  QTEST(on, "on");
  QTEST(sum_x, "sum_x");
  QTEST(sum_y, "sum_y");
  QTEST(static_cast<qint64>(events.front().time_ns / 1000), "first_us");
  QTEST(static_cast<qint64>(events.back().time_ns / 1000), "last_us");
  QCOMPARE(contents.streams[0].resolution_px.width_px, 128);
}

EVICAL_TEST(TestAedat2)
#include "tst_aedat2.moc"
