// event_camera_msgs/EventPacket in a bag: every encoding, and faults of messages.
#include "core/base/error.h"
#include "tests/core/recording/bag_builder.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <initializer_list>

using namespace evical;
using namespace evical::test;

namespace {

constexpr const char* kMd5 = "8a6101b351a64529ac77bd8b71074e52";
constexpr std::int64_t kEventPacketsStart_ns = 1'700'000'000'000'000'000;

template <class Word>
std::string words(std::initializer_list<std::uint64_t> list) {
  std::string bytes;
  for (const std::uint64_t word : list) bytes += bytesOf(static_cast<Word>(word));
  return bytes;
}

struct PacketFields {
  std::string encoding, events;
  std::int64_t stamp_ns = kEventPacketsStart_ns;
  std::uint64_t sequence = 0, time_base_ns = kEventPacketsStart_ns;
  bool big_endian = false;
};

std::string packetMessage(const PacketFields& fields) {
  return bytesOf(std::uint32_t{0}) + timeBytes(fields.stamp_ns) + sized("camera") +
         bytesOf(std::uint32_t{48}) + bytesOf(std::uint32_t{64}) + bytesOf(fields.sequence) +
         bytesOf(fields.time_base_ns) + sized(fields.encoding) +
         bytesOf(static_cast<std::uint8_t>(fields.big_endian ? 1 : 0)) + sized(fields.events);
}

std::string bagOf(const std::vector<PacketFields>& packets,
                  const std::string& type = "event_camera_msgs/EventPacket", const std::string& md5 = kMd5) {
  BagBuilder bag;
  const std::uint32_t connection = bag.addConnection("/camera", type, md5);
  for (const PacketFields& packet : packets) bag.message(connection, packet.stamp_ns, packetMessage(packet));
  return bag.finished();
}

std::string evt3(std::initializer_list<std::uint64_t> list) {
  return words<std::uint16_t>(list);
}

bool sameForEventPackets(const Event& event, std::int64_t time_ns, int x_px, int y_px, bool brighter) {
  return event.time_ns == time_ns && event.x_px == x_px && event.y_px == y_px && event.brighter == brighter;
}

const RecordingFault* faultOf(const Contents& contents, FaultKind kind) {
  for (const RecordingFault& fault : contents.faults)
    if (fault.kind == kind) return &fault;
  return nullptr;
}

// Events 1 us apart in the words of an encoding.
constexpr int kWordEvents = 100;
std::string wordsIn(const QString& encoding) {
  std::string bytes;
  for (std::uint64_t i = 0; i < kWordEvents; ++i) {
    const std::uint64_t x = i * 7 % 64, y = i * 5 % 48, on = i % 2;
    if (encoding == "evt3") {
      bytes += words<std::uint16_t>({0x8000, 0x6000 | i, y, 0x2000 | on << 11 | x});
      continue;
    }
    const bool short_words = encoding == "evt2";
    if (i % 64 == 0)
      bytes += short_words ? words<std::uint32_t>({0x80000000 | i / 64})
                           : words<std::uint64_t>({(0x80000000 | i / 64) << 32});
    bytes += short_words ? words<std::uint32_t>({on << 28 | i % 64 << 22 | x << 11 | y})
                         : words<std::uint64_t>({on << 60 | i % 64 << 54 | (x & ~31ULL) << 43 | y << 32 |
                                                 std::uint64_t{1} << (x & 31)});
  }
  return bytes;
}

}  // namespace

class TestEventPackets : public QObject {
  Q_OBJECT
 private slots:
  void type_isToldByMd5AndName_data();
  void type_isToldByMd5AndName();
  void mono_isDecoded();
  void libcaer_isDecoded();
  void libcaer_wrapsWithinAMessage();
  void libcaerCmp_isDecodedAndWarnedOf();
  void evt3_livesOnFromMessageToMessage();
  void evt3_offsetToTheHost_isTheLeastDelay();
  void wordsOfSensors_areReadByTheirContent_data();
  void wordsOfSensors_areReadByTheirContent();
  void lostMessage_takesThePosition();
  void triggers_areListed();
  void triggers_areListedWhereverTheyOccur();
  void triggerTopic_holdsNoEvents();
  void unknownEncoding_isNamed();
  void bigEndian_isRefused();
  void baseThatIsNoTime_isRefused();
  void oddLength_losesOnlyTheRest();

 private:
  Contents contentsOf(const std::string& bag) const { return readAll(folder_.write("a.bag", bag)); }
  ScratchFolder folder_;
};

void TestEventPackets::type_isToldByMd5AndName_data() {
  QTest::addColumn<QString>("type");
  QTest::addColumn<QString>("md5");
  QTest::newRow("of today") << "event_camera_msgs/EventPacket" << kMd5;
  QTest::newRow("old name") << "event_array_msgs/EventArray"
                            << "*";
  QTest::newRow("a copy") << "our_msgs/EventPacket"
                          << "*";
  QTest::newRow("renamed") << "our_msgs/Bunch" << kMd5;
}

void TestEventPackets::type_isToldByMd5AndName() {
  QFETCH(QString, type);
  QFETCH(QString, md5);
  const Contents contents =
      contentsOf(bagOf({{"mono", words<std::uint64_t>({7})}}, type.toStdString(), md5.toStdString()));
  QCOMPARE(contents.streams.at(0).type, StreamType::Events);
  QCOMPARE(contents.eventCount(), std::size_t{1});
}

void TestEventPackets::mono_isDecoded() {
  const std::uint64_t first =
      5 | (std::uint64_t{63} << 32) | (std::uint64_t{47} << 48) | (std::uint64_t{1} << 63);
  const Contents contents = contentsOf(bagOf({{"mono", words<std::uint64_t>({first, 4'000'000'000})}}));
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{2});
  QVERIFY(sameForEventPackets(events[0], kEventPacketsStart_ns + 5, 63, 47, true));
  QVERIFY(sameForEventPackets(events[1], kEventPacketsStart_ns + 4'000'000'000, 0, 0, false));
  QCOMPARE(contents.streams.at(0).resolution_px, (Resolution{64, 48}));
  QVERIFY(contents.faults.empty());
}

void TestEventPackets::libcaer_isDecoded() {
  const std::uint64_t address = 1 | 2 | (47U << 2) | (63U << 17), invalid = address & ~1U;
  const Contents contents =
      contentsOf(bagOf({{"libcaer", words<std::uint32_t>({address, 12, invalid, 13, address & ~2U, 14})}}));
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{2});
  QVERIFY(sameForEventPackets(events[0], kEventPacketsStart_ns + 12'000, 63, 47, true));
  QVERIFY(sameForEventPackets(events[1], kEventPacketsStart_ns + 14'000, 63, 47, false));
}

void TestEventPackets::libcaer_wrapsWithinAMessage() {
  const Contents contents = contentsOf(bagOf({{"libcaer", words<std::uint32_t>({1, 0x7FFFFFFF, 1, 1})}}));
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{2});
  QCOMPARE(events[1].time_ns - events[0].time_ns, std::int64_t{2000});
}

void TestEventPackets::libcaerCmp_isDecodedAndWarnedOf() {
  const Contents contents =
      contentsOf(bagOf({{"libcaer_cmp", evt3({0x0001, 0x1002, 0x203F, 0x382F, 0x4008, 0x5081, 0x5001})},
                        {"libcaer_cmp", evt3({0x2001, 0x3002}), kEventPacketsStart_ns + 1, 1,
                         kEventPacketsStart_ns + 10'000'000}}));
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{5});
  QVERIFY(sameForEventPackets(events[0], kEventPacketsStart_ns + 4'098'000, 63, 47, true));
  QVERIFY(sameForEventPackets(events[1], kEventPacketsStart_ns + 4'098'000, 63, 8, false));
  QVERIFY(sameForEventPackets(events[2], kEventPacketsStart_ns + 4'098'000, 63, 15, false));
  QVERIFY(sameForEventPackets(events[3], kEventPacketsStart_ns + 4'098'000, 63, 16, false));
  QVERIFY(
      sameForEventPackets(events[4], kEventPacketsStart_ns + 10'000'000, 1, 2, false));  // time starts again
  QVERIFY(faultOf(contents, FaultKind::Encoding) != nullptr);
}

void TestEventPackets::evt3_livesOnFromMessageToMessage() {
  const Contents contents =
      contentsOf(bagOf({{"evt3", evt3({0x8001, 0x6002, 0x0003, 0x3004})},
                        {"evt3", evt3({0x4801}), kEventPacketsStart_ns, 1},
                        {"evt3", evt3({0x5001, 0x2030, 0x2041}), kEventPacketsStart_ns, 2}}));
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{4});
  QVERIFY(sameForEventPackets(events[0], 4'098'000, 4, 3, false));
  QVERIFY(sameForEventPackets(events[1], 4'098'000, 15, 3, false));
  QVERIFY(sameForEventPackets(events[2], 4'098'000, 16, 3, false));
  QVERIFY(sameForEventPackets(events[3], 4'098'000, 48, 3, false));  // x 65 is outside
  QVERIFY(faultOf(contents, FaultKind::Outside) != nullptr);
}

void TestEventPackets::evt3_offsetToTheHost_isTheLeastDelay() {
  std::vector<PacketFields> packets;
  constexpr std::int64_t kDelays_ns[] = {900'000, 250'000, 400'000};
  for (std::uint64_t i = 0; i < 3; ++i) {
    const std::int64_t sensor_ns = 1000 * static_cast<std::int64_t>(4096 * (i + 1));
    packets.push_back({"evt3", evt3({0x8001 + i, 0x6000, 0x0003, 0x2004}),
                       kEventPacketsStart_ns + sensor_ns + kDelays_ns[i], i});
  }
  const Contents contents = contentsOf(bagOf(packets));
  const std::optional<double> offset_s = contents.streams.at(0).host_clock_offset_s;
  QVERIFY(offset_s.has_value());
  QVERIFY(std::abs(*offset_s - (1.7e9 + 250e-6)) < 1e-6);
  QVERIFY(faultOf(contents, FaultKind::HostClock) != nullptr);
}

void TestEventPackets::wordsOfSensors_areReadByTheirContent_data() {
  QTest::addColumn<QString>("stated");
  QTest::addColumn<QString>("content");
  for (const char* stated : {"evt2", "evt21", "evt3"})
    for (const char* content : {"evt2", "evt21", "evt3"})
      QTest::addRow("%s, stated as %s", content, stated) << stated << content;
}

void TestEventPackets::wordsOfSensors_areReadByTheirContent() {
  QFETCH(QString, stated);
  QFETCH(QString, content);
  const Contents contents = contentsOf(bagOf({{stated.toStdString(), wordsIn(content)}}));
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{kWordEvents});
  for (int i = 0; i < kWordEvents; ++i)
    QVERIFY(sameForEventPackets(events[static_cast<std::size_t>(i)], 1000 * i, i * 7 % 64, i * 5 % 48,
                                i % 2 == 1));
  const RecordingFault* const fault = faultOf(contents, FaultKind::Encoding);
  QCOMPARE(fault != nullptr, stated != content);
  if (fault) QVERIFY2(fault->text.find(content.toStdString()) != std::string::npos, fault->text.c_str());
}

void TestEventPackets::lostMessage_takesThePosition() {
  const Contents contents =
      contentsOf(bagOf({{"evt3", evt3({0x8001, 0x6002, 0x0003, 0x2004})},
                        {"evt3", evt3({0x2005, 0x0009, 0x2006}), kEventPacketsStart_ns, 3}}));
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{2});
  QVERIFY(sameForEventPackets(events[1], 4'098'000, 6, 9, false));
  const RecordingFault* fault = faultOf(contents, FaultKind::LostMessages);
  QVERIFY(fault != nullptr && fault->text.starts_with("2 messages"));
}

void TestEventPackets::triggers_areListed() {
  const Contents contents = contentsOf(bagOf({{"evt3", evt3({0x8001, 0x6002, 0x0003, 0x2004, 0xA101})},
                                              {"evt3", evt3({0xA100, 0xA101}), kEventPacketsStart_ns, 1}}));
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(contents.streams[1].type, StreamType::Triggers);
  QCOMPARE(contents.streams[1].messages, std::uint64_t{3});
}

// Far after the messages that are read when a recording is opened.
void TestEventPackets::triggers_areListedWhereverTheyOccur() {
  constexpr std::uint64_t kMessages = 200;
  for (const std::uint64_t triggers : {0, 2}) {
    std::vector<PacketFields> packets;
    for (std::uint64_t i = 0; i < kMessages; ++i)
      packets.push_back({"evt3", evt3({0x8001, 0x6000 + i, 0x0003, 0x2004}), kEventPacketsStart_ns, i});
    if (triggers > 0) packets.push_back({"evt3", evt3({0xA101, 0xA100}), kEventPacketsStart_ns, kMessages});
    const std::filesystem::path path = folder_.write("late.bag", bagOf(packets));
    const std::unique_ptr<RecordingReader> reader = openRecording(path);
    QCOMPARE(reader->streams().size(), std::size_t{2});
    QCOMPARE(reader->streams()[1].name, std::string("/camera/triggers"));
    const Contents contents = readAll(*reader);
    QCOMPARE(contents.eventCount(), std::size_t{kMessages});
    QCOMPARE(contents.streams[1].messages, triggers);
    QVERIFY(faultOf(contents, FaultKind::Triggers) == nullptr);
  }
}

void TestEventPackets::triggerTopic_holdsNoEvents() {
  const Contents contents = contentsOf(bagOf({{"trigger", words<std::uint64_t>({1, 2})}}));
  QCOMPARE(contents.streams.at(0).type, StreamType::Triggers);
  QCOMPARE(contents.eventCount(), std::size_t{0});
}

void TestEventPackets::unknownEncoding_isNamed() {
  const std::filesystem::path path = folder_.write("evt4.bag", bagOf({{"evt4", "abcd"}}));
  const Contents contents = readAll(path);
  const RecordingFault* fault = faultOf(contents, FaultKind::Encoding);
  QVERIFY(fault != nullptr && fault->text.find("evt4") != std::string::npos);
  QCOMPARE(contents.eventCount(), std::size_t{0});
  const std::unique_ptr<RecordingReader> reader = openRecording(path);
  try {
    reader->select({0});
    QFAIL("selected");
  } catch (const CalibrationError& error) {
    QVERIFY(error.problem().find("evt4") != std::string::npos);
  }
}

void TestEventPackets::bigEndian_isRefused() {
  const Contents contents = contentsOf(
      bagOf({{"mono", words<std::uint64_t>({7}), kEventPacketsStart_ns, 0, kEventPacketsStart_ns, true}}));
  QCOMPARE(contents.eventCount(), std::size_t{0});
  QVERIFY(faultOf(contents, FaultKind::Corrupt) != nullptr);
}

void TestEventPackets::baseThatIsNoTime_isRefused() {
  for (const char* encoding : {"mono", "libcaer", "libcaer_cmp"}) {
    for (const std::uint64_t base_ns : {std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
      const Contents contents = contentsOf(bagOf(
          {{encoding, words<std::uint64_t>({7, ~std::uint64_t{0}}), kEventPacketsStart_ns, 0, base_ns}}));
      QCOMPARE(contents.eventCount(), std::size_t{0});
      QVERIFY(faultOf(contents, FaultKind::Corrupt) != nullptr);
    }
  }
}

void TestEventPackets::oddLength_losesOnlyTheRest() {
  const Contents contents = contentsOf(bagOf({{"mono", words<std::uint64_t>({7, 8}) + "abc"}}));
  QCOMPARE(contents.eventCount(), std::size_t{2});
  QVERIFY(faultOf(contents, FaultKind::Corrupt) != nullptr);
}

EVICAL_TEST(TestEventPackets)
#include "tst_event_packets.moc"
