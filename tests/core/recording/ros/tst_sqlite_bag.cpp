// sqlite3 files and folders of ROS 2: several files are one recording, compressed ones are decompressed,
// damaged ones are read as far as possible.
#include "core/base/error.h"
#include "core/recording/ros/compression.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/core/recording/ros/ros2_builder.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <random>

using namespace evical;
using namespace evical::test;

namespace {

constexpr Resolution kSqliteBagSize_px = {64, 48};

const std::vector<RosTopic> kSqliteBagTopics = {{"/events", "dvs_msgs/msg/EventArray"},
                                                {"/imu", "sensor_msgs/msg/Imu"},
                                                {"/text", "std_msgs/msg/String"}};

// Messages `first` to `first + count` of a recording with one event message and one sample per ms.
std::vector<RosMessage> messagesFrom(std::size_t first, std::size_t count) {
  std::vector<RosMessage> messages;
  const std::vector<ImuSample> samples = someSamples(first + count);
  for (std::size_t i = first; i < first + count; ++i) {
    const std::int64_t time_ns = samples[i].time_ns;
    messages.push_back({0, time_ns, cdrEvents(kSqliteBagSize_px, someEvents(100, time_ns))});
    messages.push_back({1, time_ns, cdrImu(samples[i])});
  }
  return messages;
}

std::string metadata(const std::string& files, const std::string& mode = "") {
  return "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  "
         "relative_file_paths:\n" +
         files + "  compression_format: \"" + (mode.empty() ? "" : "zstd") + "\"\n  compression_mode: \"" +
         mode + "\"\n";
}

}  // namespace

class TestSqliteBag : public QObject {
  Q_OBJECT
 private slots:
  void file_isReadInOrderOfTime_data();
  void file_isReadInOrderOfTime();
  void folder_isOneRecording_data();
  void folder_isOneRecording();
  void filePackedWithZstd_isRead();
  void messagesPackedWithZstd_areRead();
  void missingFile_isSaid();
  void otherDatabase_isRefused();
  void truncation_isSurvived();
  void corruption_isSurvived();
  void pageOutOfPlace_endsTheReading();
  void damagedTopics_areSaid_data();
  void damagedTopics_areSaid();
  void pathWithOddCharacters_isOpened();

 private:
  std::filesystem::path fill(const std::filesystem::path& name, std::size_t first, std::size_t count) const {
    writeSqliteBag(folder_.path() / name, kSqliteBagTopics, messagesFrom(first, count));
    return folder_.path() / name;
  }
  std::filesystem::path makeFolder(const char* name) const {
    std::filesystem::create_directories(folder_.path() / name);
    return folder_.path() / name;
  }
  ScratchFolder folder_;
};

void TestSqliteBag::file_isReadInOrderOfTime_data() {
  QTest::addColumn<bool>("with_index");
  QTest::newRow("with index") << true;
  QTest::newRow("without index") << false;
}

void TestSqliteBag::file_isReadInOrderOfTime() {
  QFETCH(bool, with_index);
  std::vector<RosMessage> messages = messagesFrom(0, 50);
  if (with_index) std::swap(messages[10], messages[40]);  // stored later than it was received
  writeSqliteBag(folder_ / "a.db3", kSqliteBagTopics, messages, with_index);
  const Contents contents = readAll(folder_ / "a.db3");
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.streams.size(), std::size_t{3});
  QCOMPARE(contents.streams[0].messages, std::uint64_t{50});
  QCOMPARE(contents.streams[2].type, StreamType::Other);
  QVERIFY(sameEvents(contents.events.at(0), eventsOfMessages(50)));
  QVERIFY(sameSamples(contents.imu.at(1), someSamples(50)));
}

void TestSqliteBag::folder_isOneRecording_data() {
  QTest::addColumn<QString>("yaml");
  QTest::newRow("as metadata.yaml says")
      << QString::fromStdString(metadata("    - second.db3\n    - a_10.db3\n    - a_9.db3\n"));
  QTest::newRow("without metadata.yaml") << "";
  QTest::newRow("with a broken one") << "rosbag2_bagfile_information: [";
}

void TestSqliteBag::folder_isOneRecording() {
  QFETCH(QString, yaml);
  const bool listed = yaml.contains("second");
  const std::filesystem::path folder = makeFolder(QTest::currentDataTag());
  const auto messages = [](std::size_t first) { return messagesFrom(first, 20); };
  writeSqliteBag(folder / (listed ? "second.db3" : "a_2.db3"), kSqliteBagTopics, messages(0));
  writeSqliteBag(folder / (listed ? "a_10.db3" : "a_9.db3"), kSqliteBagTopics, messages(20));
  writeSqliteBag(folder / (listed ? "a_9.db3" : "a_10.db3"), kSqliteBagTopics, messages(40));
  if (!yaml.isEmpty()) std::ofstream(folder / "metadata.yaml") << yaml.toStdString();
  const Contents contents = readAll(folder);
  QVERIFY(sameEvents(contents.events.at(0), eventsOfMessages(60)));
  QVERIFY(sameSamples(contents.imu.at(1), someSamples(60)));
  QCOMPARE(contents.streams.at(0).messages, std::uint64_t{60});
  QCOMPARE(contents.hasFault(FaultKind::Metadata), yaml.contains("["));
}

void TestSqliteBag::filePackedWithZstd_isRead() {
  const std::filesystem::path folder = makeFolder("packed");
  std::string packed;
  for (const char* name : {"p_0.db3", "p_1.db3"}) {
    const std::string plain = fileBytes(fill(name, name[2] == '0' ? 0 : 30, 30));
    ros::packZstd(plain, packed);
    std::ofstream(folder / (std::string(name) + ".zstd"), std::ios::binary) << packed;
  }
  std::ofstream(folder / "metadata.yaml") << metadata("    - p_0.db3.zstd\n    - p_1.db3.zstd\n", "FILE");
  const Contents contents = readAll(folder);
  QVERIFY(contents.faults.empty());
  QVERIFY(sameEvents(contents.events.at(0), eventsOfMessages(60)));
  std::ofstream(folder / "p_1.db3.zstd", std::ios::binary) << packed.substr(0, packed.size() * 2 / 3);
  const Contents cut = readAll(folder);
  QVERIFY(cut.hasFault(FaultKind::Truncated));
  QVERIFY(cut.eventCount() >= 3000);
}

void TestSqliteBag::messagesPackedWithZstd_areRead() {
  std::vector<RosMessage> messages = messagesFrom(0, 20);
  for (RosMessage& message : messages) {
    const std::string plain = message.bytes;
    ros::packZstd(plain, message.bytes);
  }
  messages[6].bytes.resize(messages[6].bytes.size() / 2);
  writeSqliteBag(folder_ / "m.db3", kSqliteBagTopics, messages);
  const Contents contents = readAll(folder_ / "m.db3");
  QCOMPARE(contents.eventCount(), std::size_t{1900});
  QCOMPARE(contents.sampleCount(), std::size_t{20});
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestSqliteBag::missingFile_isSaid() {
  const std::filesystem::path folder = makeFolder("missing");
  writeSqliteBag(folder / "b_0.db3", kSqliteBagTopics, messagesFrom(0, 5));
  std::ofstream(folder / "b_2.db3") << "no database";
  std::ofstream(folder / "metadata.yaml") << metadata("    - b_0.db3\n    - b_1.db3\n    - b_2.db3\n");
  const Contents contents = readAll(folder);
  QCOMPARE(contents.eventCount(), std::size_t{500});
  QVERIFY(contents.hasFault(FaultKind::Truncated));
  QVERIFY(contents.hasFault(FaultKind::Unreadable));
}

void TestSqliteBag::otherDatabase_isRefused() {
  writeSqliteBag(folder_ / "other.db3", {}, {});
  std::string bytes = fileBytes(folder_ / "other.db3");
  for (std::size_t at = bytes.find("messages"); at != std::string::npos; at = bytes.find("messages"))
    bytes.replace(at, 8, "passages");
  QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(folder_.write("other.db3", bytes)));
}

void TestSqliteBag::truncation_isSurvived() {
  const std::string whole = fileBytes(fill("whole.db3", 0, 300));
  std::size_t most = 0;
  // A search by time fails at once if the end of the index is lost.
  const auto half = readAll(folder_.write("half.db3", whole.substr(0, whole.size() / 2)));
  QVERIFY2(half.eventCount() > 300 * 100 / 3, qPrintable(QString::number(half.eventCount())));
  for (std::size_t part = 1; part < 20; ++part) {
    const std::filesystem::path path =
        folder_.write("cut.db3", whole.substr(0, whole.size() * part / 20 + part));
    try {
      const Contents contents = readAll(path);
      QVERIFY(contents.hasFault(FaultKind::Truncated));
      most = std::max(most, contents.eventCount());
    } catch (const CalibrationError&) {
    }
  }
  QVERIFY(most > 0);
}

void TestSqliteBag::corruption_isSurvived() {
  const std::string whole = fileBytes(fill("whole.db3", 0, 100));
  std::mt19937 random(7);
  std::size_t read = 0;
  for (int i = 0; i < 60; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 40; ++k) damaged[random() % whole.size()] = static_cast<char>(random());
    try {
      read += readAll(folder_.write("damaged.db3", damaged)).eventCount();
    } catch (const CalibrationError&) {
    }
  }
  QVERIFY(read > 0);
}

// A duplicated page shifts all later ones: the tree leads to messages that were read before, and to damage
// after them, repeatedly.
void TestSqliteBag::pageOutOfPlace_endsTheReading() {
  constexpr std::size_t kPage_bytes = 4096, kEvents = 200 * 100;
  std::vector<RosMessage> messages = messagesFrom(0, 200);
  for (const bool with_index : {true, false}) {
    writeSqliteBag(folder_ / "whole.db3", kSqliteBagTopics, messages, with_index);
    const std::string whole = fileBytes(folder_ / "whole.db3");
    for (std::size_t at = 4 * kPage_bytes; at + kPage_bytes < whole.size(); at += kPage_bytes + 1021) {
      const std::string twice = whole.substr(0, at + kPage_bytes) + whole.substr(at);
      std::size_t events = 0;
      try {
        const auto reader = openRecording(folder_.write("twice.db3", twice));
        for (Packet packet; events <= kEvents && reader->read(packet);) events += packet.events.size();
        QVERIFY2(events <= kEvents, qPrintable(QString("from %1").arg(at)));
        QVERIFY2(events == kEvents || !reader->faults().empty(), qPrintable(QString("from %1").arg(at)));
      } catch (const CalibrationError&) {
      }
    }
  }
}

void TestSqliteBag::damagedTopics_areSaid_data() {
  QTest::addColumn<QString>("name");
  QTest::addColumn<QString>("type");
  QTest::addColumn<int>("topic");  // of the messages
  QTest::newRow("no name") << ""
                           << "sensor_msgs/msg/Imu" << 0;
  QTest::newRow("no type") << "/imu"
                           << "" << 0;
  QTest::newRow("not listed") << "/imu"
                              << "sensor_msgs/msg/Imu" << 1;
}

void TestSqliteBag::damagedTopics_areSaid() {
  QFETCH(QString, name);
  QFETCH(QString, type);
  QFETCH(int, topic);
  const RosMessage message{static_cast<std::size_t>(topic), 1'000, cdrImu(someSamples(1)[0])};
  writeSqliteBag(folder_ / "topics.db3", {{name.toStdString(), type.toStdString()}}, {message});
  QVERIFY(readAll(folder_ / "topics.db3").hasFault(FaultKind::Corrupt));
}

void TestSqliteBag::pathWithOddCharacters_isOpened() {
  const Contents contents = readAll(fill("50% of it? #1.db3", 0, 3));
  QCOMPARE(contents.eventCount(), std::size_t{300});
}

EVICAL_TEST(TestSqliteBag)
#include "tst_sqlite_bag.moc"
