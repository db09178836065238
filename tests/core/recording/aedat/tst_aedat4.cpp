#include "core/base/error.h"
#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/aedat/stream_description.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

std::string bytesOfAedat4(std::int32_t value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::vector<Event> eventsAt(std::int64_t start_ns, std::size_t count) {
  return someEvents(count, start_ns);
}

// A file built packet by packet, without a table.
class FileBuilder {
 public:
  FileBuilder(aedat::Compression compression, const std::vector<aedat::StreamDescription>& streams)
      : compression_(compression) {
    aedat::FileHeader header;
    header.compression = static_cast<std::int32_t>(compression);
    if (!streams.empty())
      header.description = aedat::descriptionsXml(streams, aedat::compressionName(compression));
    std::size_t position_at = 0;
    bytes_ = std::string(aedat::kMagic) + aedat::encodeHeader(header, position_at);
  }

  void add(std::int32_t stream, const std::string& content) {
    std::string packed;
    aedat::pack(compression_, content, packed);
    starts_.push_back(bytes_.size());
    bytes_ += bytesOfAedat4(stream) + bytesOfAedat4(static_cast<std::int32_t>(packed.size())) + packed;
  }

  std::string& bytes() { return bytes_; }
  const std::vector<std::size_t>& starts() const { return starts_; }  // of packets

 private:
  aedat::Compression compression_;
  std::string bytes_;
  std::vector<std::size_t> starts_;
};

std::vector<aedat::StreamDescription> cameraAndImu(const std::string& source = "DVXplorer_1",
                                                   std::int32_t first_id = 0) {
  return {{first_id, "events", "EVTS", source, {64, 48}}, {first_id + 1, "imu", "IMUS", source, {}}};
}

// In the format's units: g and deg/s.
std::vector<RawImuSample> rawSamples(std::size_t count, std::int64_t start_ns) {
  std::vector<RawImuSample> samples;
  for (const ImuSample& sample : someSamples(count, start_ns))
    samples.push_back(fromSi(sample, AccelerationUnit::Gravity, AngularRateUnit::DegreesPerSecond));
  return samples;
}

// The first sample of the file's IMU, in the file's units.
RawImuSample firstRawSample(const std::filesystem::path& path) {
  const std::unique_ptr<RecordingReader> reader = openRecording(path);
  Packet packet;
  while (reader->read(packet))
    if (!packet.imu_samples.empty()) return packet.imu_samples.front();
  return {};
}

// Six packets of 100 events, 10 samples after each.
FileBuilder smallFile(aedat::Compression compression) {
  FileBuilder file(compression, cameraAndImu());
  for (std::int64_t i = 0; i < 6; ++i) {
    file.add(0, aedat::encodeEvents(eventsAt(i * 1'000'000, 100)));
    file.add(1, aedat::encodeImu(rawSamples(10, i * 10'000'000)));
  }
  return file;
}

}  // namespace

class TestAedat4 : public QObject {
  Q_OBJECT

 private slots:
  void roundTrip_keepsEventsAndSamples_data();
  void roundTrip_keepsEventsAndSamples();
  void compressions_allRead_data();
  void compressions_allRead();
  void twoCameras_haveTheirSourceInTheName();
  void namesOfDevices_areKept_data();
  void namesOfDevices_areKept();
  void withoutXml_packetsTellTheType();
  void cutAnywhere_readsWhatIsWhole();
  void damageAnywhere_neverCrashes_data();
  void damageAnywhere_neverCrashes();
  void lyingSize_isReportedAndReadingGoesOn_data();
  void lyingSize_isReportedAndReadingGoesOn();
  void lyingCounts_loseThePacketOnly();
  void brokenFrame_losesThePacketOnly();
  void damagedTable_isNotNeeded();
  void bomb_isNotUnpacked();
  void stepBack_endsThePacket();
  void smallStepsBack_areSorted();
  void noHeader_isBadInput();
  void oldVersions_sayWhatToDo();
  void selection_isKept();
  void writer_needsTheResolution();

 private:
  ScratchFolder folder_;
};

void TestAedat4::roundTrip_keepsEventsAndSamples_data() {
  QTest::addColumn<bool>("zstd");
  QTest::newRow("lz4") << false;
  QTest::newRow("zstd") << true;
}

void TestAedat4::roundTrip_keepsEventsAndSamples() {
  QFETCH(bool, zstd);
  const std::vector<Event> events = someEvents(50'000);
  const std::vector<ImuSample> samples = someSamples(500);
  const std::filesystem::path path = folder_ / "round_trip.aedat4";
  const auto writer = createAedat4(
      path, {{"/left <1>/dvs", StreamType::Events, "", {64, 48}}, {"/imu", StreamType::Imu, "", {}}}, zstd);
  for (std::size_t i = 0; i < 50; ++i) {
    writer->write(0, EventSpan(events).subspan(i * 1000, 1000));
    writer->write(1, std::span(samples).subspan(i * 10, 10));
  }
  writer->finish();
  const Contents contents = readAll(path);
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.streams.size(), 2u);
  // Names that dv-processing expects for a single camera.
  QCOMPARE(contents.streams[0].name, std::string("events"));
  QCOMPARE(contents.streams[1].name, std::string("imu"));
  for (const StreamInfo& stream : contents.streams) QCOMPARE(stream.source, std::string("left <1>"));
  QCOMPARE(contents.streams[0].resolution_px.width_px, 64);
  QCOMPARE(contents.streams[0].messages, 50'000u);  // according to the table
  QCOMPARE(contents.streams[0].time_unit_ns, std::int64_t{1000});
  QVERIFY(sameEvents(contents.events.at(0), events));
  const std::vector<ImuSample>& read = contents.imu.at(1);
  QCOMPARE(read.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    QCOMPARE(read[i].time_ns, samples[i].time_ns);
    QVERIFY((read[i].specific_force_m_s2 - samples[i].specific_force_m_s2).norm() < 2e-6);
    QVERIFY((read[i].angular_rate_rad_s - samples[i].angular_rate_rad_s).norm() < 1e-6);
  }
  const RawImuSample raw = firstRawSample(path);
  QVERIFY(std::abs(raw.specific_force.norm() - 9.81 / 9.80665) < 0.02);  // in g, the file's unit
  QVERIFY(std::abs(raw.angular_rate.norm() - 180.0 / M_PI) < 1e-4);      // of 1 rad/s
}

void TestAedat4::compressions_allRead_data() {
  QTest::addColumn<int>("compression");
  for (int i = 0; i < aedat::kCompressions; ++i) {
    QTest::addRow("%s", aedat::compressionName(static_cast<aedat::Compression>(i)).data()) << i;
  }
}

void TestAedat4::compressions_allRead() {
  QFETCH(int, compression);
  FileBuilder file = smallFile(static_cast<aedat::Compression>(compression));
  const Contents contents = readAll(folder_.write("all.aedat4", file.bytes()));
  QCOMPARE(contents.eventCount(), 600u);
  QCOMPARE(contents.sampleCount(), 60u);
  QVERIFY(contents.faults.empty());
  QVERIFY(contents.imu.at(1)[3].angular_rate_rad_s.isApprox(someSamples(4)[3].angular_rate_rad_s, 1e-6));
}

void TestAedat4::twoCameras_haveTheirSourceInTheName() {
  std::vector<aedat::StreamDescription> streams = cameraAndImu("DAVIS346_1");
  for (const aedat::StreamDescription& stream : cameraAndImu("DAVIS346_2", 2)) streams.push_back(stream);
  streams.push_back({4, "accumulated", "FRME", "DAVIS346_1", {64, 48}});
  FileBuilder file(aedat::Compression::Lz4, streams);
  for (const std::int32_t id : {0, 2}) file.add(id, aedat::encodeEvents(eventsAt(id * 1000, 7 + id)));
  const Contents contents = readAll(folder_.write("two.aedat4", file.bytes()));
  QCOMPARE(contents.streams.size(), 5u);
  QCOMPARE(contents.streams[0].name, std::string("DAVIS346_1/events"));
  QCOMPARE(contents.streams[3].name, std::string("DAVIS346_2/imu"));
  QCOMPARE(contents.streams[4].name, std::string("accumulated"));
  QVERIFY(contents.streams[4].type == StreamType::Frames);
  QCOMPARE(contents.events.at(0).size(), 7u);
  QCOMPARE(contents.events.at(2).size(), 9u);
}

void TestAedat4::namesOfDevices_areKept_data() {
  using Names = QStringList;
  QTest::addColumn<QStringList>("topics");  // of events, except those that end with imu
  QTest::addColumn<QString>("source");      // of all of them
  QTest::addColumn<QStringList>("read");
  QTest::newRow("a camera") << Names{"/davis/events", "/davis/imu"} << ""
                            << Names{"davis: events", "davis: imu"};
  QTest::newRow("without a device") << Names{"events", "imu"} << "" << Names{"Evical: events", "Evical: imu"};
  QTest::newRow("two cameras") << Names{"/left/events", "/left/imu", "/right/events", "/right/imu"} << ""
                               << Names{"left: left/events", "left: left/imu", "right: right/events",
                                        "right: right/imu"};
  QTest::newRow("two IMUs") << Names{"/davis/events", "/davis/imu", "/board/imu"} << ""
                            << Names{"davis: events", "davis: /davis/imu", "davis: /board/imu"};
  QTest::newRow("original name") << Names{"DAVIS346_2/accumulated"} << "DAVIS346_2"
                                 << Names{"DAVIS346_2: events"};
}

void TestAedat4::namesOfDevices_areKept() {
  QFETCH(const QStringList, topics);
  QFETCH(const QString, source);
  QFETCH(const QStringList, read);
  std::vector<StreamInfo> streams;
  for (const QString& topic : topics) {
    StreamInfo& stream = streams.emplace_back();
    stream.name = topic.toStdString();
    stream.type = topic.endsWith("imu") ? StreamType::Imu : StreamType::Events;
    stream.resolution_px = {64, 48};
    stream.source = source.toStdString();
  }
  const std::filesystem::path path = folder_ / "names.aedat4";
  createAedat4(path, streams, false)->finish();
  QStringList found;
  for (const StreamInfo& stream : readAll(path).streams)
    found << QString::fromStdString(stream.source + ": " + stream.name);
  QCOMPARE(found, read);
}

void TestAedat4::withoutXml_packetsTellTheType() {
  FileBuilder file(aedat::Compression::Zstd, {});
  file.add(3, aedat::encodeImu(rawSamples(5, 0)));
  file.add(7, aedat::encodeEvents(eventsAt(0, 11)));
  const Contents contents = readAll(folder_.write("minimal.aedat4", file.bytes()));
  QCOMPARE(contents.streams.size(), 2u);
  QCOMPARE(contents.streams[0].name, std::string("imu"));
  QCOMPARE(contents.streams[1].name, std::string("events"));
  QVERIFY(!contents.streams[1].resolution_px.known());
  QCOMPARE(contents.sampleCount(), 5u);
  QCOMPARE(contents.eventCount(), 11u);
}

// Any truncation: complete packets are read, and the rest is reported.
void TestAedat4::cutAnywhere_readsWhatIsWhole() {
  FileBuilder file = smallFile(aedat::Compression::Lz4);
  const std::string whole = file.bytes();
  for (std::size_t length = 1; length < whole.size(); length += length < file.starts()[2] ? 1 : 13) {
    const std::filesystem::path path = folder_.write("cut.aedat4", whole.substr(0, length));
    if (length < file.starts()[0]) {
      QVERIFY_THROWS_EXCEPTION(CalibrationError, readAll(path));
      continue;
    }
    const Contents contents = readAll(path);
    std::size_t packets = 0;
    bool at_boundary = false;
    for (std::size_t i = 0; i < file.starts().size(); ++i) {
      const std::size_t end = i + 1 < file.starts().size() ? file.starts()[i + 1] : whole.size();
      if (end <= length) ++packets;
      at_boundary = at_boundary || file.starts()[i] == length;
    }
    QCOMPARE(contents.eventCount(), (packets + 1) / 2 * 100);
    QCOMPARE(contents.sampleCount(), packets / 2 * 10);
    QVERIFY(at_boundary ? contents.faults.empty() : !contents.faults.empty());
  }
}

void TestAedat4::damageAnywhere_neverCrashes_data() {
  compressions_allRead_data();
}

void TestAedat4::damageAnywhere_neverCrashes() {
  QFETCH(int, compression);
  const std::string whole = smallFile(static_cast<aedat::Compression>(compression)).bytes();
  for (std::size_t at = 0; at < whole.size(); at += 17) {
    for (const char value : {'\xFF', '\x7F', '\0'}) {
      std::string damaged = whole;
      damaged[at] = value;
      try {
        const Contents contents = readAll(folder_.write("damaged.aedat4", damaged));
        QVERIFY(contents.eventCount() <= 600u);
        QVERIFY(contents.sampleCount() <= 60u);
      } catch (const CalibrationError& error) {
        QVERIFY(error.kind() == ErrorKind::BadInput);
      }
    }
  }
}

void TestAedat4::lyingSize_isReportedAndReadingGoesOn_data() {
  QTest::addColumn<int>("compression");
  QTest::addColumn<int>("size");
  for (const int compression : {0, 1, 3}) {
    for (const int size : {-5, 0, 3, 500, 2'000, 2'000'000'000})
      QTest::addRow("compression %d, %d bytes", compression, size) << compression << size;
  }
}

void TestAedat4::lyingSize_isReportedAndReadingGoesOn() {
  QFETCH(int, compression);
  QFETCH(int, size);
  FileBuilder file = smallFile(static_cast<aedat::Compression>(compression));
  file.bytes().replace(file.starts()[4] + 4, 4, bytesOfAedat4(size));
  const Contents contents = readAll(folder_.write("lying.aedat4", file.bytes()));
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
  QVERIFY(contents.eventCount() == 500u || contents.eventCount() == 600u);
  QCOMPARE(contents.sampleCount(), 60u);
}

void TestAedat4::lyingCounts_loseThePacketOnly() {
  FileBuilder file(aedat::Compression::None, cameraAndImu());
  std::string events = aedat::encodeEvents(eventsAt(0, 10));
  file.add(0, events);
  events.replace(28, 4, bytesOfAedat4(11));  // one more than existing
  file.add(0, events);
  events.replace(28, 4, bytesOfAedat4(-1));
  file.add(0, events);
  std::string samples = aedat::encodeImu(rawSamples(4, 0));
  samples.replace(32, 4, bytesOfAedat4(2'000'000'000));  // position of the first sample
  file.add(1, samples);
  file.add(0, aedat::encodeEvents(eventsAt(1'000'000, 10)));
  const Contents contents = readAll(folder_.write("counts.aedat4", file.bytes()));
  QCOMPARE(contents.eventCount(), 20u);
  QCOMPARE(contents.sampleCount(), 0u);
  QCOMPARE(contents.faults.size(), 3u);
}

void TestAedat4::brokenFrame_losesThePacketOnly() {
  FileBuilder file = smallFile(aedat::Compression::Zstd);
  const std::size_t at = file.starts()[2] + 16;
  file.bytes().replace(at, 8, std::string(8, '\xFF'));
  const Contents contents = readAll(folder_.write("frame.aedat4", file.bytes()));
  QCOMPARE(contents.eventCount(), 500u);
  QCOMPARE(contents.sampleCount(), 60u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestAedat4::damagedTable_isNotNeeded() {
  const std::filesystem::path path = folder_ / "table.aedat4";
  const auto writer = createAedat4(path, {{"events", StreamType::Events, "", {64, 48}}}, false);
  writer->write(0, someEvents(5000));
  writer->finish();
  std::string bytes = fileBytes(path);
  bytes.replace(bytes.size() - 20, 20, std::string(20, '\xEE'));
  const Contents contents = readAll(folder_.write("table.aedat4", bytes));
  QCOMPARE(contents.eventCount(), 5000u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

// A frame of 140 MB of zeros, in a few kilobytes.
void TestAedat4::bomb_isNotUnpacked() {
  FileBuilder file(aedat::Compression::Zstd, cameraAndImu());
  file.add(0, aedat::encodeEvents(eventsAt(0, 10)));
  file.add(0, std::string(std::size_t{140} << 20, '\0'));
  file.add(0, aedat::encodeEvents(eventsAt(1'000'000, 10)));
  const Contents contents = readAll(folder_.write("bomb.aedat4", file.bytes()));
  QCOMPARE(contents.eventCount(), 20u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestAedat4::stepBack_endsThePacket() {
  std::vector<Event> events = eventsAt(5'000'000'000, 10);
  for (const Event& event : eventsAt(0, 5)) events.push_back(event);
  FileBuilder file(aedat::Compression::None, cameraAndImu());
  file.add(0, aedat::encodeEvents(events));
  const auto reader = openRecording(folder_.write("back.aedat4", file.bytes()));
  Packet packet;
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.events.size(), 10u);
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.events.size(), 5u);
  QVERIFY(!reader->read(packet));
}

void TestAedat4::smallStepsBack_areSorted() {
  std::vector<Event> events = eventsAt(0, 10);
  std::swap(events[3], events[4]);
  FileBuilder file(aedat::Compression::None, cameraAndImu());
  file.add(0, aedat::encodeEvents(events));
  const Contents contents = readAll(folder_.write("unsorted.aedat4", file.bytes()));
  QVERIFY(sameEvents(contents.events.at(0), eventsAt(0, 10)));
  QVERIFY(contents.hasFault(FaultKind::Unsorted));
}

void TestAedat4::noHeader_isBadInput() {
  const std::string magic(aedat::kMagic);
  for (const std::string& header :
       {std::string(), std::string(4, '\0'), std::string(4, '\xFF'),
        bytesOfAedat4(20) + std::string(20, '\xFF'), bytesOfAedat4(8) + bytesOfAedat4(4) + "IOHE"}) {
    try {
      openRecording(folder_.write("header.aedat4", magic + header));
      QFAIL("a file without a header was opened");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY(error.problem().find("byte 14") != std::string::npos);
    }
  }
}

void TestAedat4::oldVersions_sayWhatToDo() {
  try {
    openRecording(folder_.write("old.aedat", "#!AER-DAT3.0\r\n"));
    QFAIL("an AEDAT3.0 file was opened");
  } catch (const CalibrationError& error) {
    QVERIFY(error.advice().find("3.1") != std::string::npos);
  }
}

void TestAedat4::selection_isKept() {
  const auto reader =
      openRecording(folder_.write("select.aedat4", smallFile(aedat::Compression::Lz4).bytes()));
  reader->select({1});
  const Contents contents = readAll(*reader);
  QCOMPARE(contents.eventCount(), 0u);
  QCOMPARE(contents.sampleCount(), 60u);
  QCOMPARE(reader->fractionRead(), 1.0);
}

void TestAedat4::writer_needsTheResolution() {
  QVERIFY_THROWS_EXCEPTION(
      CalibrationError, createAedat4(folder_ / "no.aedat4", {{"events", StreamType::Events, "", {}}}, false));
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    QVERIFY(!entry.path().filename().string().starts_with("no.aedat4"));
}

EVICAL_TEST(TestAedat4)
#include "tst_aedat4.moc"
