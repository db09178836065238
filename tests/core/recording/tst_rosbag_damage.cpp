// Bags from crashed recorders, full disks and bad cables: complete records are read, losses are reported, and
// no bytes crash the reader or make it use much memory.
#include "core/base/error.h"
#include "tests/core/recording/bag_builder.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <cstring>
#include <random>

using namespace evical;
using namespace evical::test;

namespace {

constexpr Resolution kRosbagDamageSize_px = {64, 48};
constexpr std::int64_t kRosbagDamageStart_ns = 1'700'000'000'000'000'000;
constexpr std::size_t kMessages = 12, kEventsEach = 20;

// 3 chunks of 4 event messages and 4 IMU messages each.
BagBuilder smallBag(const std::string& compression) {
  BagBuilder bag(compression);
  const std::uint32_t events = bag.addEvents("/events"), imu = bag.addImu("/imu");
  const std::vector<ImuSample> samples = someSamples(kMessages);
  for (std::size_t i = 0; i < kMessages; ++i) {
    const std::int64_t time_ns = samples[i].time_ns;
    bag.message(events, time_ns,
                eventMessage(time_ns, kRosbagDamageSize_px, someEvents(kEventsEach, time_ns)));
    bag.message(imu, time_ns, imuMessage(samples[i]));
    if (i % 4 == 3) bag.endChunk();
  }
  return bag;
}

// The data read must be a subset of the written data.
bool isTrue(const Contents& contents) {
  for (const auto& [stream, events] : contents.events) {
    if (events.size() % kEventsEach != 0) return false;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const std::vector<Event> expected = someEvents(kEventsEach, events[i - i % kEventsEach].time_ns);
      const Event &a = events[i], &b = expected[i % kEventsEach];
      if (a.time_ns != b.time_ns || a.x_px != b.x_px || a.y_px != b.y_px || a.brighter != b.brighter)
        return false;
    }
  }
  return true;
}

// The outcome is a result or a CalibrationError.
void readAnything(const std::filesystem::path& path) {
  try {
    readAll(path);
  } catch (const CalibrationError&) {
  }
}

void replaceNumber(std::string& bytes, std::size_t position, std::uint32_t value) {
  bytes.replace(position, sizeof value, bytesOf(value));
}

}  // namespace

class TestRosbagDamage : public QObject {
  Q_OBJECT
 private slots:
  void truncation_anywhere_givesWhatIsWhole_data();
  void truncation_anywhere_givesWhatIsWhole();
  void truncationWithinAPlainChunk_keepsTheMessagesBefore();
  void corruption_anywhere_isSurvived_data();
  void corruption_anywhere_isSurvived();
  void corruptChunk_losesNoOther_data();
  void corruptChunk_losesNoOther();
  void damagedRecordHeader_losesOneChunkWhereThereIsAnIndex();
  void chunkOfZeros_losesNoOther_data();
  void chunkOfZeros_losesNoOther();
  void falseChunkLength_losesNoOther_data();
  void falseChunkLength_losesNoOther();
  void damagedIndex_doesNotHinder();
  void indexCutBetweenItsRecords_losesNothing();
  void messageWithAFalseCount_isLeftOut();
  void lyingLengths_takeNoMemory_data();
  void lyingLengths_takeNoMemory();
  void stampBeyondASecond_isLeftOut();

 private:
  ScratchFolder folder_;
};

void TestRosbagDamage::truncation_anywhere_givesWhatIsWhole_data() {
  QTest::addColumn<QString>("compression");
  QTest::addColumn<bool>("finished");
  for (const char* name : {"none", "lz4", "bz2"}) {
    QTest::addRow("%s", name) << name << true;
    QTest::addRow("%s without index", name) << name << false;
  }
}

void TestRosbagDamage::truncation_anywhere_givesWhatIsWhole() {
  QFETCH(QString, compression);
  QFETCH(bool, finished);
  BagBuilder bag = smallBag(compression.toStdString());
  const std::string whole = finished ? bag.finished() : bag.unfinished();
  std::size_t most = 0;
  for (std::size_t size = 13; size < whole.size(); size += size < 4100 ? 1021 : 23) {
    const Contents contents = readAll(folder_.write("cut.bag", whole.substr(0, size)));
    QVERIFY2(isTrue(contents), qPrintable(QString("cut at %1").arg(size)));
    QVERIFY2(finished ? !contents.faults.empty() : true, qPrintable(QString("cut at %1").arg(size)));
    QVERIFY2(contents.eventCount() >= most, qPrintable(QString("cut at %1").arg(size)));
    most = std::max(most, contents.eventCount());
    std::size_t whole_chunks = 0;  // those completely before the cut
    while (whole_chunks + 1 < bag.chunkPositions().size() && bag.chunkPositions()[whole_chunks + 1] <= size)
      ++whole_chunks;
    QVERIFY2(contents.eventCount() >= whole_chunks * 4 * kEventsEach,
             qPrintable(QString("cut at %1").arg(size)));
  }
  QCOMPARE(most, kMessages * kEventsEach);
}

void TestRosbagDamage::truncationWithinAPlainChunk_keepsTheMessagesBefore() {
  BagBuilder bag = smallBag("none");
  const std::string whole = bag.unfinished();
  const std::size_t second = bag.chunkPositions()[1], third = bag.chunkPositions()[2];
  const Contents contents =
      readAll(folder_.write("cut.bag", whole.substr(0, second + 2 * (third - second) / 3)));
  QVERIFY(contents.eventCount() > 4 * kEventsEach);
  QVERIFY(contents.eventCount() < 8 * kEventsEach);
  QVERIFY(contents.hasFault(FaultKind::Truncated));
  QVERIFY(!contents.hasFault(FaultKind::Corrupt));  // a recorder may still be writing it
  QVERIFY(isTrue(contents));
}

void TestRosbagDamage::corruption_anywhere_isSurvived_data() {
  QTest::addColumn<QString>("compression");
  for (const char* name : {"none", "lz4", "bz2"}) QTest::newRow(name) << name;
}

void TestRosbagDamage::corruption_anywhere_isSurvived() {
  QFETCH(QString, compression);
  const std::string whole = smallBag(compression.toStdString()).finished();
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> places(13, whole.size() - 1);
  std::uniform_int_distribution<int> values(0, 255);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    for (int k = 0; k < 1 + i % 20; ++k) bytes[places(random)] = static_cast<char>(values(random));
    readAnything(folder_.write("corrupt.bag", bytes));
  }
}

void TestRosbagDamage::corruptChunk_losesNoOther_data() {
  QTest::addColumn<QString>("compression");
  for (const char* name : {"lz4", "bz2"}) QTest::newRow(name) << name;
}

void TestRosbagDamage::corruptChunk_losesNoOther() {
  QFETCH(QString, compression);
  BagBuilder bag = smallBag(compression.toStdString());
  std::string bytes = bag.finished();
  bytes.replace(bag.chunkPositions()[1] + 120, 60, std::string(60, '\xFF'));
  const Contents contents = readAll(folder_.write("chunk.bag", bytes));
  QCOMPARE(contents.eventCount(), 8 * kEventsEach);
  QVERIFY(isTrue(contents));
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

// The second chunk's header length is invalid; the index states the third chunk's position.
void TestRosbagDamage::damagedRecordHeader_losesOneChunkWhereThereIsAnIndex() {
  BagBuilder bag = smallBag("lz4");
  std::string bytes = bag.finished();
  replaceNumber(bytes, bag.chunkPositions()[1], 0x7FFFFFFF);
  const Contents contents = readAll(folder_.write("header.bag", bytes));
  QCOMPARE(contents.eventCount(), 8 * kEventsEach);
  QVERIFY(isTrue(contents));
  QVERIFY(!contents.faults.empty());
}

void TestRosbagDamage::chunkOfZeros_losesNoOther_data() {
  QTest::addColumn<QString>("compression");
  QTest::addColumn<bool>("finished");
  QTest::addColumn<int>("chunk");
  for (const char* name : {"none", "lz4", "bz2"}) {
    for (int chunk = 0; chunk < 3; ++chunk) {
      QTest::addRow("%s %d", name, chunk) << name << true << chunk;
      QTest::addRow("%s %d without index", name, chunk) << name << false << chunk;
    }
  }
}

// A region lost by a disk: records before and after it are read, also without an index.
void TestRosbagDamage::chunkOfZeros_losesNoOther() {
  QFETCH(QString, compression);
  QFETCH(bool, finished);
  QFETCH(int, chunk);
  BagBuilder bag = smallBag(compression.toStdString());
  const std::size_t end_of_chunks = bag.unfinished().size();
  std::string bytes = finished ? bag.finished() : bag.unfinished();
  std::vector<std::size_t> bounds = bag.chunkPositions();
  bounds.push_back(end_of_chunks);
  const auto k = static_cast<std::size_t>(chunk);
  bytes.replace(bounds[k], bounds[k + 1] - bounds[k], std::string(bounds[k + 1] - bounds[k], '\0'));
  const Contents contents = readAll(folder_.write("zeros.bag", bytes));
  // Connections are in the first chunk and in the index.
  QCOMPARE(contents.eventCount(), chunk == 0 && !finished ? 0 : 8 * kEventsEach);
  QVERIFY(isTrue(contents));
  QVERIFY(contents.hasFault(finished || chunk > 0 ? FaultKind::Corrupt : FaultKind::NoIndex));
}

void TestRosbagDamage::falseChunkLength_losesNoOther_data() {
  QTest::addColumn<QString>("compression");
  QTest::addColumn<bool>("finished");
  QTest::addColumn<int>("error");
  for (const char* name : {"none", "lz4", "bz2"}) {
    for (const int error : {-500, -1, 1, 300, 2000, 100'000, 1'000'000'000}) {
      QTest::addRow("%s %d", name, error) << name << true << error;
      QTest::addRow("%s %d without index", name, error) << name << false << error;
    }
  }
}

void TestRosbagDamage::falseChunkLength_losesNoOther() {
  QFETCH(QString, compression);
  QFETCH(bool, finished);
  QFETCH(int, error);
  BagBuilder bag = smallBag(compression.toStdString());
  bag.endChunk();
  std::string bytes = finished ? bag.finished() : bag.unfinished();
  const std::size_t length = bag.chunkPositions()[1] + 54 + compression.size();
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + length, sizeof value);
  replaceNumber(bytes, length, value + static_cast<std::uint32_t>(error));
  const Contents contents = readAll(folder_.write("length.bag", bytes));
  QVERIFY2(contents.eventCount() >= 8 * kEventsEach, qPrintable(QString::number(contents.eventCount())));
  QVERIFY(isTrue(contents));
  QVERIFY(!contents.faults.empty());
}

void TestRosbagDamage::damagedIndex_doesNotHinder() {
  std::string bytes = smallBag("lz4").finished();
  bytes.replace(bytes.size() - 60, 30, std::string(30, '\xFF'));
  const Contents contents = readAll(folder_.write("index.bag", bytes));
  QCOMPARE(contents.eventCount(), kMessages * kEventsEach);
  QVERIFY(isTrue(contents));
  QVERIFY(!contents.faults.empty());
}

// The rest of the index looks complete, but lacks the last chunk, or two, or a connection.
void TestRosbagDamage::indexCutBetweenItsRecords_losesNothing() {
  BagBuilder bag = smallBag("lz4");
  const std::size_t index = bag.unfinished().size();
  const std::string whole = bag.finished();
  std::size_t end = index;
  while (end < whole.size()) {
    const Contents contents = readAll(folder_.write("between.bag", whole.substr(0, end)));
    QCOMPARE(contents.eventCount(), kMessages * kEventsEach);
    QCOMPARE(contents.sampleCount(), kMessages);
    QVERIFY(!contents.faults.empty());
    for (int part = 0; part < 2; ++part) {  // header and data, each preceded by its length
      std::uint32_t length = 0;
      std::memcpy(&length, whole.data() + end, sizeof length);
      end += sizeof length + length;
    }
  }
}

void TestRosbagDamage::messageWithAFalseCount_isLeftOut() {
  BagBuilder bag;
  const std::uint32_t events = bag.addEvents("/events");
  for (const std::uint32_t count : {20U, 0xFFFFFFFFU, 20U, 21U, 20U}) {
    std::string message = eventMessage(kRosbagDamageStart_ns, kRosbagDamageSize_px, someEvents(kEventsEach));
    replaceNumber(message, message.size() - 13 * kEventsEach - 4, count);
    bag.message(events, kRosbagDamageStart_ns, message);
  }
  const Contents contents = readAll(folder_.write("count.bag", bag.finished()));
  QCOMPARE(contents.eventCount(), 3 * kEventsEach);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestRosbagDamage::lyingLengths_takeNoMemory_data() {
  QTest::addColumn<int>("offset");  // relative to the second chunk's beginning
  QTest::newRow("header length") << 0;
  QTest::newRow("field length") << 4;
  QTest::newRow("uncompressed size") << 53;
  QTest::newRow("data length") << 57;
  QTest::newRow("LZ4 frame") << 61;
}

void TestRosbagDamage::lyingLengths_takeNoMemory() {
  QFETCH(int, offset);
  BagBuilder bag = smallBag("lz4");
  const std::string whole = bag.finished();
  for (const std::uint32_t value : {0U, 1U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    std::string bytes = whole;
    replaceNumber(bytes, bag.chunkPositions()[1] + static_cast<std::size_t>(offset), value);
    const Contents contents = readAll(folder_.write("lies.bag", bytes));
    QVERIFY(contents.eventCount() >= 4 * kEventsEach);
    QVERIFY(isTrue(contents));
  }
}

void TestRosbagDamage::stampBeyondASecond_isLeftOut() {
  BagBuilder bag;
  const std::uint32_t events = bag.addEvents("/events");
  std::string message = eventMessage(kRosbagDamageStart_ns, kRosbagDamageSize_px, someEvents(kEventsEach));
  bag.message(events, kRosbagDamageStart_ns, message);
  replaceNumber(message, message.size() - 5, 3'000'000'000U);  // nanoseconds of the last event
  bag.message(events, kRosbagDamageStart_ns, message);
  const Contents contents = readAll(folder_.write("stamp.bag", bag.finished()));
  QCOMPARE(contents.eventCount(), kEventsEach);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

EVICAL_TEST(TestRosbagDamage)
#include "tst_rosbag_damage.moc"
