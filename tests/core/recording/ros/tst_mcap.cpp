// MCAP: written data are read back, other programs' files are read, and damage loses no more than necessary.
#include "core/base/error.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/core/recording/ros/ros2_builder.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QProcess>
#include <QTest>

#include <random>

using namespace evical;
using namespace evical::test;

namespace {

constexpr Resolution kMcapSize_px = {64, 48};

const std::vector<RosTopic> kMcapTopics = {{"/events", "dvs_msgs/msg/EventArray"},
                                           {"/imu", "sensor_msgs/msg/Imu"}};

// 30 messages of 100 events each, and as many samples.
std::vector<RosMessage> someMessages() {
  std::vector<RosMessage> messages;
  const std::vector<ImuSample> samples = someSamples(30);
  for (const ImuSample& sample : samples) {
    messages.push_back({0, sample.time_ns, cdrEvents(kMcapSize_px, someEvents(100, sample.time_ns))});
    messages.push_back({1, sample.time_ns, cdrImu(sample)});
  }
  return messages;
}

// Events of the only stream with events: without a summary, streams are in the order of their messages.
std::vector<Event> eventsOf(const Contents& contents) {
  for (const auto& [stream, events] : contents.events)
    if (!events.empty()) return events;
  return {};
}

bool isPartOf(const std::vector<Event>& part, const std::vector<Event>& whole) {
  const auto before = [](const Event& a, const Event& b) {
    return std::tuple(a.time_ns, a.x_px, a.y_px) < std::tuple(b.time_ns, b.x_px, b.y_px);
  };
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end(), before);
}

}  // namespace

class TestMcap : public QObject {
  Q_OBJECT
 private slots:
  void roundTrip_isExact_data();
  void roundTrip_isExact();
  void otherProgram_followsEveryIndex();
  void filesOfOthers_areRead_data();
  void filesOfOthers_areRead();
  void bigEndianMessages_areRead();
  void unknownEncoding_isListedOnly();
  void select_leavesOutTheOthers();
  void writer_refusesTimesThatRosCannotHold();
  void truncation_givesWhatIsWhole_data() { roundTrip_isExact_data(); }
  void truncation_givesWhatIsWhole();
  void truncationAtEveryByte_ofAPlainFile_isSurvived();
  void corruption_isSurvived_data() { roundTrip_isExact_data(); }
  void corruption_isSurvived();
  void bytesMissingFromTheBeginning_areSaid_data();
  void bytesMissingFromTheBeginning_areSaid();
  void missingSchema_isSaid();
  void corruptChunk_losesNoOther();
  void lyingSizes_takeNoMemory();

 private:
  std::filesystem::path write(McapCompression compression, const std::vector<Event>& events,
                              const std::vector<ImuSample>& samples) const {
    const std::vector<StreamInfo> streams = {{"/events", StreamType::Events, "", kMcapSize_px},
                                             {"/imu", StreamType::Imu, "", {}}};
    const auto writer = createMcap(folder_ / "a.mcap", streams, compression);
    std::size_t event = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t count = std::min(events.size() - event, events.size() / samples.size() + 1);
      writer->write(0, EventSpan(events).subspan(event, count));
      writer->write(1, std::span(samples).subspan(i, 1));
      event += count;
    }
    writer->write(0, EventSpan(events).subspan(event));
    writer->finish();
    return folder_ / "a.mcap";
  }
  ScratchFolder folder_;
};

void TestMcap::roundTrip_isExact_data() {
  QTest::addColumn<McapCompression>("compression");
  QTest::newRow("none") << McapCompression::None;
  QTest::newRow("lz4") << McapCompression::Lz4;
  QTest::newRow("zstd") << McapCompression::Zstd;
}

void TestMcap::roundTrip_isExact() {
  QFETCH(McapCompression, compression);
  const std::vector<Event> events = someEvents(200'000);
  const std::vector<ImuSample> samples = someSamples(2000);
  const Contents contents = readAll(write(compression, events, samples));
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(contents.streams[0].message, "dvs_msgs/msg/EventArray");
  QCOMPARE(contents.streams[0].resolution_px, kMcapSize_px);
  QCOMPARE(contents.streams[1].messages, std::uint64_t{2000});
  QVERIFY(sameEvents(contents.events.at(0), events));
  QVERIFY(sameSamples(contents.imu.at(1), samples));
}

void TestMcap::otherProgram_followsEveryIndex() {
  const std::filesystem::path path = write(McapCompression::None, someEvents(200'000), someSamples(2000));
  QProcess python;
  python.setProcessChannelMode(QProcess::ForwardedErrorChannel);
  python.start("/usr/bin/python3",
               {QString::fromStdString(test::sourcePath("tests/core/recording/ros/check_mcap.py")),
                QString::fromStdString(path.string())});
  if (!python.waitForStarted()) QSKIP("python3 is not installed");
  python.waitForFinished(300'000);
  QCOMPARE(python.readAllStandardOutput().trimmed(), QByteArray("2200 4"));
}

void TestMcap::filesOfOthers_areRead_data() {
  QTest::addColumn<int>("chunk_messages");
  QTest::newRow("without chunks") << 0;
  QTest::newRow("chunks without indexes") << 7;
}

void TestMcap::filesOfOthers_areRead() {
  QFETCH(int, chunk_messages);
  const Contents contents = readAll(folder_.write(
      "b.mcap", mcapFile(kMcapTopics, someMessages(), static_cast<std::size_t>(chunk_messages))));
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.streams.at(0).messages, std::uint64_t{30});
  QVERIFY(sameEvents(contents.events.at(0), eventsOfMessages(30)));
  QVERIFY(sameSamples(contents.imu.at(1), someSamples(30)));
}

void TestMcap::bigEndianMessages_areRead() {
  const std::vector<Event> events = someEvents(10);
  const Contents contents = readAll(folder_.write(
      "be.mcap", mcapFile(kMcapTopics, {{0, events[0].time_ns, cdrEvents(kMcapSize_px, events, true)}})));
  QVERIFY(sameEvents(contents.events.at(0), events));
}

void TestMcap::unknownEncoding_isListedOnly() {
  const std::vector<RosTopic> topics = {{"/events", "dvs_msgs/msg/EventArray", "json"}};
  const Contents contents = readAll(folder_.write("json.mcap", mcapFile(topics, {{0, 1, "{}"}})));
  QCOMPARE(contents.streams.at(0).type, StreamType::Other);
  QCOMPARE(contents.streams.at(0).messages, std::uint64_t{1});
}

void TestMcap::select_leavesOutTheOthers() {
  const auto reader = openRecording(write(McapCompression::Zstd, someEvents(1000), someSamples(10)));
  reader->select({1});
  const Contents contents = readAll(*reader);
  QCOMPARE(contents.eventCount(), std::size_t{0});
  QCOMPARE(contents.sampleCount(), std::size_t{10});
}

void TestMcap::writer_refusesTimesThatRosCannotHold() {
  const std::vector<StreamInfo> streams = {{"/imu", StreamType::Imu, "", {}}};
  const auto writer = createMcap(folder_ / "time.mcap", streams, McapCompression::None);
  std::vector<ImuSample> samples(1);
  samples[0].time_ns = std::int64_t{1'000'000'000} << 31;
  QVERIFY_THROWS_EXCEPTION(CalibrationError, writer->write(0, samples));
  samples[0].time_ns = -1;
  QVERIFY_THROWS_EXCEPTION(CalibrationError, writer->write(0, samples));
}

void TestMcap::truncation_givesWhatIsWhole() {
  QFETCH(McapCompression, compression);
  const std::vector<Event> events = someEvents(200'000);
  const std::string whole = fileBytes(write(compression, events, someSamples(2000)));
  std::size_t most = 0;
  const std::size_t step = whole.size() / 40 + 1;
  for (std::size_t size = 8; size < whole.size(); size += step) {
    const Contents contents = readAll(folder_.write("cut.mcap", whole.substr(0, size)));
    QVERIFY(!contents.faults.empty());
    const std::vector<Event> found = eventsOf(contents);
    QVERIFY2(sameEvents(found, {events.begin(), events.begin() + static_cast<std::ptrdiff_t>(found.size())}),
             qPrintable(QString("cut at %1").arg(size)));
    QVERIFY(found.size() >= most);
    most = found.size();
  }
  QVERIFY(most > events.size() * 6 / 10);
}

void TestMcap::truncationAtEveryByte_ofAPlainFile_isSurvived() {
  std::vector<RosMessage> messages = someMessages();
  messages.resize(4);
  const std::string whole = mcapFile(kMcapTopics, messages, 3);
  for (std::size_t size = 8; size < whole.size(); size += size % 3 + 1) {
    const Contents contents = readAll(folder_.write("cut.mcap", whole.substr(0, size)));
    QVERIFY2(contents.hasFault(FaultKind::NoIndex), qPrintable(QString("cut at %1").arg(size)));
    QVERIFY(isPartOf(eventsOf(contents), eventsOfMessages(30)));
  }
}

void TestMcap::corruption_isSurvived() {
  QFETCH(McapCompression, compression);
  const std::string whole = fileBytes(write(compression, someEvents(20'000), someSamples(100)));
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[8 + random() % (whole.size() - 8)] = static_cast<char>(random());
    try {
      readAll(folder_.write("damaged.mcap", damaged));
    } catch (const CalibrationError&) {
    }
  }
}

void TestMcap::bytesMissingFromTheBeginning_areSaid_data() {
  QTest::addColumn<int>("chunk_messages");
  QTest::newRow("no chunks") << 0;
  QTest::newRow("chunks") << 20;
}

// Damage of the first records: everything is read, or there is a fault.
void TestMcap::bytesMissingFromTheBeginning_areSaid() {
  QFETCH(int, chunk_messages);
  const std::string whole = mcapFile(kMcapTopics, someMessages(), static_cast<std::size_t>(chunk_messages));
  for (std::size_t at = 8; at < 160; at += 3) {
    for (const std::size_t count : {1, 2, 5, 8, 9, 17, 27, 40, 64}) {
      std::string bytes = whole;
      bytes.erase(at, count);
      const Contents contents = readAll(folder_.write("missing.mcap", bytes));
      const bool is_whole = contents.eventCount() == 3000 && contents.sampleCount() == 30;
      QVERIFY2(is_whole || !contents.faults.empty(), qPrintable(QString("%1 at %2").arg(count).arg(at)));
    }
  }
}

void TestMcap::missingSchema_isSaid() {
  std::string bytes = mcapFile(kMcapTopics, someMessages());
  std::size_t second = bytes.find('\3');  // the record's kind; its id follows the length
  while (bytes.compare(second + 9, 2, std::string("\2\0", 2)) != 0) second = bytes.find('\3', second + 1);
  bytes[second] = '\x0C';  // metadata, which readers pass over
  const Contents contents = readAll(folder_.write("schema.mcap", bytes));
  QCOMPARE(contents.sampleCount(), std::size_t{0});
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestMcap::corruptChunk_losesNoOther() {
  const std::vector<Event> events = someEvents(300'000);
  std::string bytes = fileBytes(write(McapCompression::Zstd, events, someSamples(10)));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  bytes[bytes.size() / 2 + 100] = static_cast<char>(bytes[bytes.size() / 2 + 100] ^ 0x55);
  const Contents contents = readAll(folder_.write("damaged.mcap", bytes));
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
  QVERIFY(contents.eventCount() >= events.size() * 6 / 10);
}

// A chunk with a stated size of 2^60 bytes.
void TestMcap::lyingSizes_takeNoMemory() {
  for (const std::string_view name : {"lz4", "zstd"}) {
    std::string bytes = fileBytes(write(name == "lz4" ? McapCompression::Lz4 : McapCompression::Zstd,
                                        someEvents(1000), someSamples(10)));
    const std::size_t compression = bytes.find(name);
    bytes[compression - 4 - 4 - 1] = 0x10;  // the highest byte of the uncompressed size
    const Contents contents = readAll(folder_.write("lie.mcap", bytes));
    QVERIFY(contents.hasFault(FaultKind::Corrupt));
    QCOMPARE(contents.eventCount(), std::size_t{0});
  }
}

EVICAL_TEST(TestMcap)
#include "tst_mcap.moc"
