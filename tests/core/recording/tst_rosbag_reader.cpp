// Contents of ROS 1 bags are read for every compression and naming.
#include "core/base/error.h"
#include "core/recording/recording_reader.h"
#include "tests/core/recording/bag_builder.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTest>

using namespace evical;
using namespace evical::test;

namespace {

const std::filesystem::path kRosbagReaderData = test::sourcePath("tests/data/recordings");
constexpr Resolution kRosbagReaderSize_px = {64, 48};
constexpr std::int64_t kRosbagReaderStart_ns = 1'700'000'000'000'000'000;

const char* const kEventDefinition =
    "# a private copy\nstd_msgs/Header header\nuint32 height\nuint32   width\nour_msgs/Event[] events\n"
    "=====\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
    "=====\nMSG: our_msgs/Event\nuint16 x # column\nuint16 y\ntime ts\nbool polarity\n";

std::string bagWith(const std::string& type, const std::string& md5, const std::string& definition) {
  BagBuilder bag;
  const std::uint32_t connection = bag.addConnection("/events", type, md5, definition);
  bag.message(connection, kRosbagReaderStart_ns,
              eventMessage(kRosbagReaderStart_ns, kRosbagReaderSize_px, someEvents(5)));
  return bag.finished();
}

}  // namespace

class TestRosbagReader : public QObject {
  Q_OBJECT
 private slots:
  void chunks_ofEachCompression_giveTheSame_data();
  void chunks_ofEachCompression_giveTheSame();
  void bagOfPythonRosbag_isReadExactly();
  void bagWithoutEvents_listsItsTopics();
  void type_isToldByMd5NameOrDefinition_data();
  void type_isToldByMd5NameOrDefinition();
  void select_leavesOutTheOthers();
  void twoConnectionsOfATopic_areOneStream();
  void publishersInTurn_areTwoStreams_data();
  void publishersInTurn_areTwoStreams();
  void oldEvents_areReadByTheirDefinition();
  void unreadTypesOfSensors_areNamed_data();
  void unreadTypesOfSensors_areNamed();
  void splitBags_areJoined();
  void topicsOfBagWrite_areThoseOfTheRecords_data();
  void topicsOfBagWrite_areThoseOfTheRecords();
  void lateTopic_isDescribedAtOpening();
  void sizeOfZero_isTolerated();
  void emptyBag_hasNoStreams();
  void bagWithoutIndex_isReadInSequence();
  void zeroStamps_areReplacedByRecordTimes();
  void recordingThatBeginsAtZero_keepsItsTimes();
  void unorderedEvents_areSortedInThePacket();
  void clockResetWithinAMessage_isNotSortedAway();
  void partOfASplitBag_saysSo_data();
  void partOfASplitBag_saysSo();
  void longMessage_isReadWhole();
  void fractionRead_growsToOne();
  void findStream_ofAWrongTopic_namesThoseThereAre();

 private:
  ScratchFolder folder_;
};

void TestRosbagReader::chunks_ofEachCompression_giveTheSame_data() {
  QTest::addColumn<QString>("compression");
  for (const char* name : {"none", "lz4", "bz2"}) QTest::newRow(name) << name;
}

void TestRosbagReader::chunks_ofEachCompression_giveTheSame() {
  QFETCH(QString, compression);
  BagBuilder bag(compression.toStdString());
  const std::uint32_t left = bag.addEvents("/left/events"), imu = bag.addImu("/imu"),
                      right = bag.addEvents("/right");
  const std::vector<Event> events = someEvents(3000);
  const std::vector<ImuSample> samples = someSamples(30);
  for (std::size_t i = 0; i < 30; ++i) {
    const auto begin = events.begin() + static_cast<std::ptrdiff_t>(100 * i);
    const std::vector<Event> part(begin, begin + 100);
    bag.message(left, part.back().time_ns, eventMessage(part.front().time_ns, kRosbagReaderSize_px, part));
    bag.message(right, part.back().time_ns, eventMessage(part.front().time_ns, {32, 24}, {part[0]}));
    bag.message(imu, samples[i].time_ns, imuMessage(samples[i]));
    if (i % 10 == 9) bag.endChunk();
  }
  const Contents contents = readAll(folder_.write("a.bag", bag.finished()));
  QCOMPARE(contents.streams.size(), std::size_t{3});
  QVERIFY(contents.faults.empty());
  const std::size_t left_stream =
      findStream(*openRecording(folder_ / "a.bag"), "/left/events", StreamType::Events);
  const std::size_t imu_stream = findStream(*openRecording(folder_ / "a.bag"), "/imu", StreamType::Imu);
  QVERIFY(sameEvents(contents.events.at(left_stream), events));
  QVERIFY(sameSamples(contents.imu.at(imu_stream), samples));
  QCOMPARE(contents.streams[left_stream].resolution_px, kRosbagReaderSize_px);
  QCOMPARE(contents.streams[left_stream].messages, std::uint64_t{30});
  QCOMPARE(contents.eventCount(), std::size_t{3030});
}

// Numbers from the script that wrote the file.
void TestRosbagReader::bagOfPythonRosbag_isReadExactly() {
  const Contents contents = readAll(kRosbagReaderData / "rosbag_python_bz2.bag");
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.eventCount(), std::size_t{1000});
  QCOMPARE(contents.sampleCount(), std::size_t{100});
  std::uint64_t on = 0, sum_x = 0, sum_y = 0, sum_t = 0;
  for (const auto& [stream, events] : contents.events) {
    for (const Event& event : events) {
      on += event.brighter ? 1 : 0;
      sum_x += event.x_px;
      sum_y += event.y_px;
      sum_t += static_cast<std::uint64_t>(event.time_ns);
    }
  }
  QCOMPARE(on, std::uint64_t{333});
  QCOMPARE(sum_x, std::uint64_t{30600});
  QCOMPARE(sum_y, std::uint64_t{23464});
  QCOMPARE(sum_t, std::uint64_t{2899545268671251328U});
  for (const auto& [stream, samples] : contents.imu) {
    for (const ImuSample& sample : samples) {
      QCOMPARE(sample.specific_force_m_s2, Eigen::Vector3d(0.5, -0.25, 9.75));
      QCOMPARE(sample.angular_rate_rad_s, Eigen::Vector3d(0.1, 0.2, 0.3));
    }
  }
}

void TestRosbagReader::bagWithoutEvents_listsItsTopics() {
  const Contents contents = readAll(kRosbagReaderData / "no_event_topics_lz4.bag");
  QCOMPARE(contents.streams.size(), std::size_t{9});
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.eventCount() + contents.sampleCount(), std::size_t{0});
  std::uint64_t messages = 0;
  for (const StreamInfo& stream : contents.streams) {
    QCOMPARE(stream.type, StreamType::Other);
    messages += stream.messages;
  }
  QCOMPARE(messages, std::uint64_t{8647});
}

void TestRosbagReader::type_isToldByMd5NameOrDefinition_data() {
  QTest::addColumn<QString>("type");
  QTest::addColumn<QString>("md5");
  QTest::addColumn<QString>("definition");
  QTest::addColumn<bool>("are_events");
  QTest::newRow("dvs_msgs") << "dvs_msgs/EventArray" << kEventArrayMd5 << "" << true;
  QTest::newRow("prophesee") << "prophesee_event_msgs/EventArray" << kEventArrayMd5 << "" << true;
  QTest::newRow("renamed, md5 kept") << "our_msgs/Bunch" << kEventArrayMd5 << "" << true;
  QTest::newRow("private copy, by name") << "our_msgs/EventArray"
                                         << "*"
                                         << "" << true;
  QTest::newRow("same fields") << "our_msgs/Bunch"
                               << "0123" << kEventDefinition << true;
  QTest::newRow("other fields, same name") << "our_msgs/EventArray"
                                           << "0123"
                                           << "uint32 count\nfloat64[] values\n"
                                           << false;
  QTest::newRow("other fields, known name") << "dvs_msgs/EventArray"
                                            << "0123"
                                            << "uint32 count\nfloat64[] values\n"
                                            << false;
  QTest::newRow("something else") << "std_msgs/String"
                                  << "992ce8a1687cec8c8bd883ec73ca41d1"
                                  << "string data\n"
                                  << false;
}

void TestRosbagReader::type_isToldByMd5NameOrDefinition() {
  QFETCH(QString, type);
  QFETCH(QString, md5);
  QFETCH(QString, definition);
  QFETCH(bool, are_events);
  const std::string bytes = bagWith(type.toStdString(), md5.toStdString(), definition.toStdString());
  const Contents contents = readAll(folder_.write("type.bag", bytes));
  QCOMPARE(contents.streams.size(), std::size_t{1});
  QCOMPARE(contents.streams[0].type == StreamType::Events, are_events);
  QCOMPARE(contents.eventCount(), std::size_t{are_events ? 5U : 0U});
}

void TestRosbagReader::select_leavesOutTheOthers() {
  const std::unique_ptr<RecordingReader> reader = openRecording(kRosbagReaderData / "rosbag_python_bz2.bag");
  reader->select({findStream(*reader, "/dvs/imu", StreamType::Imu)});
  const Contents contents = readAll(*reader);
  QCOMPARE(contents.eventCount(), std::size_t{0});
  QCOMPARE(contents.sampleCount(), std::size_t{100});
}

void TestRosbagReader::twoConnectionsOfATopic_areOneStream() {
  BagBuilder bag;
  for (int i = 0; i < 2; ++i)
    bag.message(bag.addEvents("/events"), kRosbagReaderStart_ns,
                eventMessage(kRosbagReaderStart_ns, kRosbagReaderSize_px, someEvents(4)));
  const Contents contents = readAll(folder_.write("two.bag", bag.finished()));
  QCOMPARE(contents.streams.size(), std::size_t{1});
  QCOMPARE(contents.eventCount(), std::size_t{8});
}

void TestRosbagReader::publishersInTurn_areTwoStreams_data() {
  QTest::addColumn<bool>("in_turn");
  QTest::addColumn<bool>("named");
  QTest::newRow("in turn") << true << true;
  QTest::newRow("restarted") << false << true;
  QTest::newRow("in turn, without names") << true << false;
  QTest::newRow("restarted, without names") << false << false;
}

void TestRosbagReader::publishersInTurn_areTwoStreams() {
  QFETCH(bool, in_turn);
  QFETCH(bool, named);
  constexpr int kMessages = 12;
  BagBuilder bag;
  const std::uint32_t nodes[] = {bag.addEvents("/events"), bag.addEvents("/events")};
  if (named) bag.setPublisher(nodes[0], "/left");
  if (named) bag.setPublisher(nodes[1], "/right");
  for (int i = 0; i < kMessages; ++i) {
    const std::int64_t time_ns = kRosbagReaderStart_ns + i * std::int64_t{1'000'000};
    bag.message(nodes[in_turn ? i % 2 : i / (kMessages / 2)], time_ns,
                eventMessage(time_ns, kRosbagReaderSize_px, someEvents(4, time_ns)));
  }
  const Contents contents = readAll(folder_.write("publishers.bag", bag.finished()));
  QCOMPARE(contents.streams.size(), std::size_t{in_turn ? 2U : 1U});
  QCOMPARE(contents.eventCount(), std::size_t{48});
  QCOMPARE(contents.streams[0].name, std::string(!in_turn ? "/events"
                                                 : named  ? "/events of /left"
                                                          : "/events of connection 0"));
  QCOMPARE(contents.hasFault(FaultKind::Metadata), in_turn);
}

void TestRosbagReader::oldEvents_areReadByTheirDefinition() {
  BagBuilder bag;
  const std::uint32_t connection = bag.addConnection(
      "/dvs/events", "dvs_msgs/EventArray", "d2e726b2040dbc135644f4709c150a10",
      "Event[] events\n====\nMSG: dvs_msgs/Event\nuint16 x\nuint16 y\nuint64 time\nbool polarity\n");
  std::string message = bytesOf(std::uint32_t{2});
  for (std::uint16_t i = 0; i < 2; ++i)
    message +=
        bytesOf(i) + bytesOf(std::uint16_t{7}) + bytesOf(std::uint64_t{1000U + i}) + bytesOf(std::uint8_t{1});
  bag.message(connection, kRosbagReaderStart_ns, message);
  const Contents contents = readAll(folder_.write("old.bag", bag.finished()));
  QCOMPARE(contents.eventCount(), std::size_t{2});
  QCOMPARE(contents.events.at(0)[1].time_ns, std::int64_t{1'001'000});
  QCOMPARE(int{contents.events.at(0)[1].y_px}, 7);
  QVERIFY(contents.faults.empty());
}

void TestRosbagReader::unreadTypesOfSensors_areNamed_data() {
  QTest::addColumn<QString>("topic");
  QTest::addColumn<QString>("type");
  QTest::addColumn<QString>("said");
  QTest::newRow("vectors") << "/imu/gyro"
                           << "geometry_msgs/Vector3Stamped"
                           << "probably of an IMU";
  QTest::newRow("PX4") << "/fmu/out/sensor_combined"
                       << "px4_msgs/SensorCombined"
                       << "probably of an IMU";
  QTest::newRow("raw IMU") << "/novatel/raw"
                           << "novatel_gps_msgs/RawImu"
                           << "probably of an IMU";
  QTest::newRow("events") << "/davis/events"
                          << "our_msgs/EventBatchArray"
                          << "probably with events";
  QTest::newRow("a log") << "/rosout"
                         << "rosgraph_msgs/Log"
                         << "";
  QTest::newRow("a position") << "/gps"
                              << "geometry_msgs/Vector3Stamped"
                              << "";
}

void TestRosbagReader::unreadTypesOfSensors_areNamed() {
  QFETCH(QString, topic);
  QFETCH(QString, type);
  QFETCH(QString, said);
  BagBuilder bag;
  const std::uint32_t connection =
      bag.addConnection(topic.toStdString(), type.toStdString(), "0123", "float64 x\nfloat64 y\n");
  bag.message(connection, kRosbagReaderStart_ns, std::string(16, '\0'));
  const Contents contents = readAll(folder_.write("types.bag", bag.finished()));
  QCOMPARE(contents.faults.size(), std::size_t{said.isEmpty() ? 0U : 1U});
  if (said.isEmpty()) return;
  const QString text = QString::fromStdString(contents.faults.front().text);
  QVERIFY2(text.contains(said) && text.contains(topic) && text.contains(type), qPrintable(text));
}

void TestRosbagReader::splitBags_areJoined() {
  const std::filesystem::path folder = folder_ / "split";
  std::filesystem::create_directory(folder);
  const std::string bag = bagWith("dvs_msgs/EventArray", kEventArrayMd5, "");
  for (int i = 0; i < 11; ++i)
    std::ofstream(folder / ("a_" + std::to_string(i) + ".bag"), std::ios::binary) << bag;
  QCOMPARE(readAll(folder).eventCount(), 55u);
  std::ofstream(folder / "other.bag", std::ios::binary) << bag;
  QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(folder));
}

void TestRosbagReader::topicsOfBagWrite_areThoseOfTheRecords_data() {
  QTest::addColumn<bool>("finished");
  QTest::addColumn<QString>("in_data");  // null: nothing
  for (const bool finished : {true, false}) {
    const char* index = finished ? "" : ", no index";
    QTest::addRow("no topic in the data%s", index) << finished << QString();
    QTest::addRow("empty topic in the data%s", index) << finished << QString("");
    QTest::addRow("publisher's name in the data%s", index) << finished << QString("/imu");
  }
}

// Two IMUs without a topic in their data remain two.
void TestRosbagReader::topicsOfBagWrite_areThoseOfTheRecords() {
  QFETCH(bool, finished);
  QFETCH(QString, in_data);
  BagBuilder bag;
  const std::vector<ImuSample> samples = someSamples(6);
  for (std::size_t imu = 0; imu < 2; ++imu) {
    const std::uint32_t connection = bag.addImu("/imu" + std::to_string(imu));
    bag.setTopicInData(connection, in_data.isNull() ? std::nullopt : std::optional(in_data.toStdString()));
    for (std::size_t i = 3 * imu; i < 3 * imu + 3; ++i)
      bag.message(connection, samples[i].time_ns, imuMessage(samples[i]));
  }
  const Contents contents = readAll(folder_.write("write.bag", finished ? bag.finished() : bag.unfinished()));
  QCOMPARE(contents.streams.size(), std::size_t{2});
  for (std::size_t imu = 0; imu < 2; ++imu) {
    QCOMPARE(contents.streams[imu].name, "/imu" + std::to_string(imu));
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(3 * imu);
    QVERIFY(sameSamples(contents.imu.at(imu), {first, first + 3}));
  }
}

// The index states its beginning, after any number of other topics' messages.
void TestRosbagReader::lateTopic_isDescribedAtOpening() {
  BagBuilder bag;
  const std::uint32_t early = bag.addEvents("/early"), late = bag.addEvents("/late");
  const std::string message = eventMessage(kRosbagReaderStart_ns, {32, 24}, someEvents(1));
  for (int i = 0; i < 30'000; ++i) {
    bag.message(early, kRosbagReaderStart_ns, message);
    if (i % 500 == 0) bag.endChunk();
  }
  bag.message(late, kRosbagReaderStart_ns,
              eventMessage(kRosbagReaderStart_ns, kRosbagReaderSize_px, someEvents(1)));
  const std::unique_ptr<RecordingReader> reader = openRecording(folder_.write("late.bag", bag.finished()));
  QCOMPARE(reader->streams().at(1).resolution_px, kRosbagReaderSize_px);
}

void TestRosbagReader::sizeOfZero_isTolerated() {
  BagBuilder bag;
  const std::uint32_t events = bag.addEvents("/events");
  bag.message(events, kRosbagReaderStart_ns, eventMessage(kRosbagReaderStart_ns, {0, 0}, someEvents(4)));
  const Contents contents = readAll(folder_.write("size.bag", bag.finished()));
  QVERIFY(!contents.streams.at(0).resolution_px.known());
  QCOMPARE(contents.eventCount(), std::size_t{4});
}

void TestRosbagReader::emptyBag_hasNoStreams() {
  const Contents contents = readAll(folder_.write("empty.bag", BagBuilder().finished()));
  QVERIFY(contents.streams.empty());
  QCOMPARE(contents.eventCount(), std::size_t{0});
}

void TestRosbagReader::bagWithoutIndex_isReadInSequence() {
  BagBuilder bag("lz4");
  const std::uint32_t events = bag.addEvents("/events");
  bag.message(events, kRosbagReaderStart_ns,
              eventMessage(kRosbagReaderStart_ns, kRosbagReaderSize_px, someEvents(40)));
  bag.endChunk();
  const std::uint32_t imu = bag.addImu("/imu");
  for (const ImuSample& sample : someSamples(7)) bag.message(imu, sample.time_ns, imuMessage(sample));
  const Contents contents = readAll(folder_.write("unfinished.bag", bag.unfinished()));
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(contents.eventCount(), std::size_t{40});
  QCOMPARE(contents.sampleCount(), std::size_t{7});
  QCOMPARE(contents.faults.size(), std::size_t{1});
  QCOMPARE(contents.streams[0].resolution_px, kRosbagReaderSize_px);
}

void TestRosbagReader::zeroStamps_areReplacedByRecordTimes() {
  BagBuilder bag;
  const std::uint32_t events = bag.addEvents("/events"), imu = bag.addImu("/imu");
  for (std::int64_t i = 0; i < 5; ++i) {
    std::vector<Event> stampless = someEvents(3);
    for (Event& event : stampless) event.time_ns = 0;
    bag.message(events, kRosbagReaderStart_ns + i, eventMessage(0, kRosbagReaderSize_px, stampless));
    bag.message(imu, kRosbagReaderStart_ns + i, imuMessage(ImuSample()));
  }
  const Contents contents = readAll(folder_.write("stampless.bag", bag.finished()));
  QVERIFY(contents.hasFault(FaultKind::NoStamps));
  QCOMPARE(contents.events.at(0).front().time_ns, kRosbagReaderStart_ns);
  QCOMPARE(contents.events.at(0).back().time_ns, kRosbagReaderStart_ns + 4);
  QCOMPARE(contents.imu.at(1).back().time_ns, kRosbagReaderStart_ns + 4);
}

// A simulator's clock may start at zero; its first stamp then does not count as missing.
void TestRosbagReader::recordingThatBeginsAtZero_keepsItsTimes() {
  BagBuilder bag;
  const std::uint32_t events = bag.addEvents("/events"), imu = bag.addImu("/imu");
  const std::vector<ImuSample> samples = someSamples(5, 0);
  bag.message(events, kRosbagReaderStart_ns, eventMessage(0, kRosbagReaderSize_px, someEvents(1, 0)));
  bag.message(events, kRosbagReaderStart_ns,
              eventMessage(10'000, kRosbagReaderSize_px, someEvents(50, 10'000)));
  for (const ImuSample& sample : samples) bag.message(imu, kRosbagReaderStart_ns, imuMessage(sample));
  const Contents contents = readAll(folder_.write("zero.bag", bag.finished()));
  QVERIFY(!contents.hasFault(FaultKind::NoStamps));
  QVERIFY(sameSamples(contents.imu.at(1), samples));
  QCOMPARE(contents.events.at(0).front().time_ns, std::int64_t{0});
}

void TestRosbagReader::unorderedEvents_areSortedInThePacket() {
  std::vector<Event> events = someEvents(100);
  const std::vector<Event> ordered = events;
  std::swap(events[10], events[11]);
  std::swap(events[50], events[52]);
  BagBuilder bag;
  const std::uint32_t connection = bag.addEvents("/events");
  bag.message(connection, kRosbagReaderStart_ns,
              eventMessage(kRosbagReaderStart_ns, kRosbagReaderSize_px, events));
  const Contents contents = readAll(folder_.write("unordered.bag", bag.finished()));
  QVERIFY(sameEvents(contents.events.at(0), ordered));
  QCOMPARE(contents.faults.size(), std::size_t{1});
  QCOMPARE(contents.faults[0].kind, FaultKind::Unsorted);
  QVERIFY(contents.faults[0].text.find(" 3 times") != std::string::npos);
}

void TestRosbagReader::clockResetWithinAMessage_isNotSortedAway() {
  std::vector<Event> events = someEvents(60);
  for (std::size_t i = 30; i < events.size(); ++i) events[i].time_ns -= 5'000'000'000;
  BagBuilder bag;
  const std::uint32_t connection = bag.addEvents("/events");
  bag.message(connection, kRosbagReaderStart_ns,
              eventMessage(kRosbagReaderStart_ns, kRosbagReaderSize_px, events));
  const std::unique_ptr<RecordingReader> reader = openRecording(folder_.write("reset.bag", bag.finished()));
  Packet packet;
  for (const std::size_t first : {0, 30}) {
    QVERIFY(reader->read(packet));
    QCOMPARE(packet.events.size(), std::size_t{30});
    QCOMPARE(packet.events.front().time_ns, events[first].time_ns);
  }
  QVERIFY(!reader->read(packet));
}

// 300000 events are a chunk of 4 MB.
void TestRosbagReader::partOfASplitBag_saysSo_data() {
  QTest::addColumn<QStringList>("files");  // the first one is read
  QTest::addColumn<bool>("expected");
  QTest::newRow("first") << QStringList{"a_0.bag", "a_1.bag"} << true;
  QTest::newRow("last") << QStringList{"a_2.bag", "a_0.bag", "a_1.bag"} << true;
  QTest::newRow("with time") << QStringList{"a_2024-05-06-07-08-09_0.bag", "a_2024-05-06-07-09-09_1.bag"}
                             << true;
  QTest::newRow("alone") << QStringList{"a_0.bag", "b_1.bag"} << false;
  QTest::newRow("numbered by people") << QStringList{"a_1.bag", "a_2.bag"} << false;
  QTest::newRow("of another") << QStringList{"a_1.bag", "b_0.bag", "b_2.bag"} << false;
}

void TestRosbagReader::partOfASplitBag_saysSo() {
  QFETCH(QStringList, files);
  QFETCH(bool, expected);
  const std::filesystem::path folder = folder_ / QTest::currentDataTag();
  std::filesystem::create_directory(folder);
  const std::string bag = bagWith("dvs_msgs/EventArray", kEventArrayMd5, "");
  for (const QString& file : files) std::ofstream(folder / file.toStdString(), std::ios::binary) << bag;
  const Contents contents = readAll(folder / files[0].toStdString());
  QCOMPARE(contents.eventCount(), 5u);
  QCOMPARE(contents.hasFault(FaultKind::Part), expected);
  if (expected) QVERIFY(contents.faults[0].text.find("a_") != std::string::npos);
}

void TestRosbagReader::longMessage_isReadWhole() {
  const std::vector<Event> events = someEvents(300'000);
  BagBuilder bag("lz4");
  const std::uint32_t connection = bag.addEvents("/events");
  bag.message(connection, kRosbagReaderStart_ns,
              eventMessage(kRosbagReaderStart_ns, kRosbagReaderSize_px, events));
  const Contents contents = readAll(folder_.write("long.bag", bag.finished()));
  QVERIFY(sameEvents(contents.events.at(0), events));
}

void TestRosbagReader::fractionRead_growsToOne() {
  const std::unique_ptr<RecordingReader> reader = openRecording(kRosbagReaderData / "rosbag_python_bz2.bag");
  Packet packet;
  double last = reader->fractionRead();
  while (reader->read(packet)) {
    QVERIFY(reader->fractionRead() >= last && reader->fractionRead() <= 1.0);
    last = reader->fractionRead();
  }
  QVERIFY(reader->fractionRead() > 0.99);
}

void TestRosbagReader::findStream_ofAWrongTopic_namesThoseThereAre() {
  const std::unique_ptr<RecordingReader> reader = openRecording(kRosbagReaderData / "rosbag_python_bz2.bag");
  try {
    findStream(*reader, "/davis/events", StreamType::Events);
    QFAIL("nothing was thrown");
  } catch (const CalibrationError& error) {
    QCOMPARE(error.kind(), ErrorKind::BadInput);
    QVERIFY(std::string(error.what()).find("/dvs/events") != std::string::npos);
    QVERIFY(std::string(error.what()).find("/dvs/imu") == std::string::npos);
  }
}

EVICAL_TEST(TestRosbagReader)
#include "tst_rosbag_reader.moc"
