// AEDAT 3.1: its packets, several cameras, and the data that remain after damage.
#include "core/base/error.h"
#include "tests/core/recording/aedat/aedat3_builder.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

using namespace evical;
using namespace evical::test;

namespace {

constexpr std::int64_t kOverflow_ns = (std::int64_t{1} << 31) * 1000;

std::string someFile() {
  return aedat3Header() + aedat3Events(someEvents(20, 5'000'000)) +
         aedat3Imu(5100, {0.0F, 0.0F, 1.0F, 10.0F, 20.0F, 30.0F, 25.0F}) +
         aedat3FramePacket({1, 5000, 7000}) + aedat3Events(someEvents(20, 6'000'000));
}

}  // namespace

class TestAedat3 : public QObject {
  Q_OBJECT

 private slots:
  void events_areDecoded();
  void overflows_areAdded();
  void imuSamples_areDecoded_data();
  void imuSamples_areDecoded();
  void frames_haveTheMiddleOfTheExposure();
  void colouredFrames_haveTheUpperBits();
  void otherFrames_areLeftOutAndSaid();
  void invalidEvents_areLeftOut();
  void severalCameras_areToldApart();
  void triggers_areCounted();
  void compressedFiles_areRefusedByName();
  void everyCut_keepsWhatIsWhole();
  void damagedPacket_losesNoOther();
  void lateTimes_areLeftOut();
  void damageAnywhere_neverCrashes();

 private:
  Contents read(const std::string& bytes) const {
    return readEverything(scratch_.write("file.aedat", bytes));
  }
  ScratchFolder scratch_;
};

void TestAedat3::events_areDecoded() {
  std::vector<Event> events = someEvents(50'000, 5'000'000);
  events[9].x_px = 239;
  events[9].y_px = 179;
  const std::vector<Event> first(events.begin(), events.begin() + 20'000),
      rest(events.begin() + 20'000, events.end());
  const Contents contents = read(aedat3Header() + aedat3Events(first) + aedat3Events(rest));
  QVERIFY(sameEvents(contents.events.at(0), events));
  QCOMPARE(contents.streams.size(), std::size_t{1});
  QCOMPARE(contents.streams[0].resolution_px.width_px, 240);
  QCOMPARE(contents.streams[0].messages, std::uint64_t{50'000});
  QVERIFY(contents.faults.empty());
}

void TestAedat3::overflows_areAdded() {
  const std::vector<Event> events = someEvents(10, 5'000'000);
  const Contents contents = read(aedat3Header() + aedat3Events(events, 3));
  QCOMPARE(contents.events.at(0)[2].time_ns, 3 * kOverflow_ns + events[2].time_ns);
}

void TestAedat3::imuSamples_areDecoded_data() {
  QTest::addColumn<bool>("nine_axes");
  QTest::newRow("six axes") << false;
  QTest::newRow("nine axes") << true;
}

void TestAedat3::imuSamples_areDecoded() {
  QFETCH(bool, nine_axes);
  const auto reader = openRecording(scratch_.write(
      "imu.aedat",
      aedat3Header() + aedat3Imu(5100, {0.25F, -0.5F, 1.0F, 10.0F, 20.0F, -30.0F, 25.0F}, nine_axes)));
  QVERIFY(reader->streams()[0].type == StreamType::Imu);
  QVERIFY(reader->streams()[0].acceleration_unit == AccelerationUnit::Gravity);
  QVERIFY(reader->streams()[0].angular_rate_unit == AngularRateUnit::DegreesPerSecond);
  Packet packet;
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.imu_samples[0].time_ns, 5'100'000);
  QVERIFY(packet.imu_samples[0].specific_force == Eigen::Vector3d(0.25, -0.5, 1.0));
  QVERIFY(packet.imu_samples[0].angular_rate == Eigen::Vector3d(10.0, 20.0, -30.0));
}

void TestAedat3::frames_haveTheMiddleOfTheExposure() {
  const std::filesystem::path path =
      scratch_.write("a.aedat", aedat3Header() + aedat3FramePacket({1, 5000, 7000}));
  QCOMPARE(readAll(path).frameCount(), 0u);  // by default
  const Contents contents = readEverything(path);
  QCOMPARE(contents.frameCount(), 1u);
  const Frame& frame = contents.frames.at(0)[0];
  QCOMPARE(frame.time_ns, 6'000'000);
  QCOMPARE(frame.exposure_s, 0.002);
  QVERIFY(frame.format == FrameFormat::Gray16);
  QVERIFY(!frame.big_endian);
  QCOMPARE(frame.row_bytes, 6u);
  QCOMPARE(frame.bytes.size(), 12u);
  QCOMPARE(int(frame.bytes[2]), 7);  // low byte of the second pixel
  QCOMPARE(int(frame.bytes[3]), 2);
  QCOMPARE(contents.streams[0].resolution_px.width_px, 3);
}

void TestAedat3::colouredFrames_haveTheUpperBits() {
  const Contents contents = read(aedat3Header() + aedat3FramePacket({3, 5000, 7000}));
  const Frame& frame = contents.frames.at(0)[0];
  QVERIFY(frame.format == FrameFormat::Rgb8);
  QCOMPARE(frame.row_bytes, 9u);
  QCOMPARE(frame.bytes.size(), 18u);
  QCOMPARE(int(frame.bytes[0]), 1);
  QCOMPARE(int(frame.bytes[17]), 18);
}

void TestAedat3::otherFrames_areLeftOutAndSaid() {
  Aedat3Frame part{1, 5000, 7000}, large = part, two_channels = part;
  part.left = 4;
  two_channels.channels = 2;
  large.width = 300;
  const std::string good = aedat3FramePacket({1, 5000, 7000});
  for (const Aedat3Frame& bad : {part, two_channels}) {
    const Contents contents = read(aedat3Header() + aedat3FramePacket(bad) + good);
    QCOMPARE(contents.frameCount(), 1u);
    QVERIFY(contents.hasFault(FaultKind::Encoding));
  }
  const Contents contents = read(aedat3Header() + aedat3FramePacket(large) + good);
  QCOMPARE(contents.frameCount(), 1u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestAedat3::invalidEvents_areLeftOut() {
  std::string packet = aedat3Events(someEvents(3, 5'000'000));
  packet[28 + 8] = static_cast<char>(packet[28 + 8] & ~1);
  QCOMPARE(read(aedat3Header() + packet).eventCount(), 2u);
}

void TestAedat3::severalCameras_areToldApart() {
  const std::vector<Event> events = someEvents(10, 5'000'000);
  const Contents contents = read(aedat3Header() + aedat3Events(events, 0, 1) +
                                 aedat3Events({events[0]}, 0, 2) + aedat3Events(events, 0, 1));
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(QString::fromStdString(contents.streams[1].name), QString("source 2/events"));
  QCOMPARE(contents.events.at(0).size(), std::size_t{20});
  QCOMPARE(contents.events.at(1).size(), std::size_t{1});
  QVERIFY(contents.hasFault(FaultKind::NoResolution));  // of the camera that is missing in the header
}

void TestAedat3::triggers_areCounted() {
  std::string events;
  for (const std::uint32_t kind : {1U, 2U, 3U, 0U, 16U})
    events += bytesOf(1U | kind << 1) + bytesOf(std::int32_t{9});
  const Contents contents = read(aedat3Header() + aedat3Packet(0, 8, events));
  QVERIFY(contents.streams[0].type == StreamType::Triggers);
  QCOMPARE(contents.streams[0].messages, std::uint64_t{2});
}

void TestAedat3::compressedFiles_areRefusedByName() {
  std::string header = aedat3Header();
  header.replace(header.find("RAW"), 3, "SerializedTS");
  try {
    openRecording(scratch_.write("packed.aedat", header));
    QFAIL("opened");
  } catch (const CalibrationError& error) {
    QVERIFY(error.problem().find("SerializedTS") != std::string::npos);
  }
  QVERIFY_THROWS_EXCEPTION(CalibrationError,
                           openRecording(scratch_.write("cut.aedat", aedat3Header().substr(0, 40))));
}

void TestAedat3::everyCut_keepsWhatIsWhole() {
  const std::string first = aedat3Header() + aedat3Events(someEvents(5, 5'000'000));
  const std::string whole = first + aedat3Events(someEvents(5, 6'000'000));
  for (std::size_t size = first.size(); size < whole.size(); ++size) {
    const Contents contents = read(whole.substr(0, size));
    QCOMPARE(contents.eventCount(), 5u);
    const std::string said = contents.faults.empty() ? "" : contents.faults[0].text;
    QVERIFY2(contents.hasFault(FaultKind::Truncated) == (size != first.size()), said.c_str());
  }
}

void TestAedat3::damagedPacket_losesNoOther() {
  const std::string header = aedat3Header(), packet = aedat3Events(someEvents(5, 5'000'000));
  for (const std::size_t at : {0u, 2u, 4u, 8u, 16u, 20u, 24u}) {  // of its header
    std::string damaged = packet;
    damaged[at + 1] = '\x7F';
    const Contents contents = read(header + packet + damaged + packet + packet);
    QCOMPARE(contents.eventCount(), 15u);
    QVERIFY(contents.hasFault(FaultKind::Corrupt));
  }
}

void TestAedat3::lateTimes_areLeftOut() {
  const Contents contents = read(aedat3Header() + aedat3Events(someEvents(5, 5'000'000), INT32_MAX) +
                                 aedat3Events(someEvents(5, 5'000'000)));
  QCOMPARE(contents.eventCount(), 5u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestAedat3::damageAnywhere_neverCrashes() {
  const std::string whole = someFile();
  QCOMPARE(read(whole).eventCount(), 40u);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char value : {'\0', '\x7F', '\xFF'}) {
      std::string damaged = whole;
      damaged[at] = value;
      try {
        QVERIFY(read(damaged).eventCount() <= 40);
      } catch (const CalibrationError&) {
        // Bad files cause this error.
      }
    }
  }
}

EVICAL_TEST(TestAedat3)
#include "tst_aedat3.moc"
