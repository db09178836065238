// Small files that unpack to gigabytes, or whose lists take quadratic time: each reader refuses them before
// they cost more than 10 s and 512 MB.
#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/aedat/stream_description.h"
#include "core/recording/inspection.h"
#include "core/recording/ros/compression.h"
#include "tests/core/recording/bag_builder.h"
#include "tests/core/recording/numpy/numpy_builder.h"
#include "tests/core/recording/ros/ros2_builder.h"
#include "tests/support/file_cost.h"
#include "tests/support/test_program.h"

#include <bzlib.h>
#include <sqlite3.h>
#include <QProcess>
#include <QTemporaryDir>

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

using namespace evical;
using namespace evical::test;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPart_bytes = 100'000'000;  // that each part unpacks to

std::string zeros() {
  return std::string(kPart_bytes, '\0');
}

std::string repeated(const std::string& part, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += part;
  return all;
}

std::string zstdZeros() {
  std::string packed;
  ros::packZstd(zeros(), packed);
  return packed;
}

std::string bz2Zeros() {
  std::string plain = zeros(), packed(1 << 20, '\0');
  auto size = static_cast<unsigned>(packed.size());
  BZ2_bzBuffToBuffCompress(packed.data(), &size, plain.data(), static_cast<unsigned>(plain.size()), 9, 0, 0);
  packed.resize(size);
  return packed;
}

// A bag without an index, with chunks of the same packed data.
std::string bagOfChunks(const std::string& compression, const std::string& packed, std::size_t unpacked_bytes,
                        std::size_t count) {
  const std::string chunk = sized(field("op", bytesOf(std::uint8_t{5})) + field("compression", compression) +
                                  field("size", bytesOf(static_cast<std::uint32_t>(unpacked_bytes)))) +
                            sized(packed);
  return BagBuilder().unfinished() + repeated(chunk, count);
}

std::string bz2Bag() {
  return bagOfChunks("bz2", bz2Zeros(), kPart_bytes, 100);
}

std::string lz4Bag() {
  constexpr std::size_t kChunk_bytes = 300'000'000;
  std::string packed;
  ros::packLz4(std::string(kChunk_bytes, '\0'), packed);
  return bagOfChunks("lz4", packed, kChunk_bytes, 1);
}

std::string bagOfConnections() {
  BagBuilder bag;
  for (int i = 0; i < 30'000; ++i)
    bag.message(bag.addImu(fmt::format("/imu_{}", i)), 1'000'000'000, imuMessage({}));
  return bag.finished();
}

std::string mcapOfChunks() {
  const std::string packed = zstdZeros();
  const std::string chunk = mcapRecord(
      0x06, bytesOf(std::uint64_t{1}) + bytesOf(std::uint64_t{2}) + bytesOf(std::uint64_t{kPart_bytes}) +
                bytesOf(std::uint32_t{0}) + sized("zstd") + bytesOf(std::uint64_t{packed.size()}) + packed);
  const std::string whole = mcapFile({{"/imu", "sensor_msgs/msg/Imu"}}, {{0, 1, cdrImu({})}});
  return whole.substr(0, 8) + repeated(chunk, 300) + whole.substr(8);
}

std::string mcapOfChannels() {
  std::vector<RosTopic> topics;
  for (int i = 0; i < 65'000; ++i) topics.push_back({fmt::format("/imu_{}", i), "sensor_msgs/msg/Imu"});
  return mcapFile(topics, {{0, 1'000'000'000, cdrImu({})}});
}

// One definition of a megabyte, which each channel names.
std::string mcapOfDefinitions() {
  std::string file = mcapFile({}, {}).substr(0, 8) +
                     mcapRecord(0x03, bytesOf(std::uint16_t{1}) + sized("a/msg/B") + sized("ros2msg") +
                                          sized(std::string(1 << 20, '#')));
  for (std::uint16_t id = 1; id < 9000; ++id)
    file += mcapRecord(0x04, bytesOf(id) + bytesOf(std::uint16_t{1}) + sized(fmt::format("/{}", id)) +
                                 sized("cdr") + sized(""));
  return file;
}

std::string zstdFile() {
  return repeated(zstdZeros(), 20);
}

std::string gzText() {
  std::string lines = repeated("0.5 10 20 1\n", 8'000'000), packed(lines.size() / 50, '\0');
  z_stream state{};
  deflateInit2(&state, 6, Z_DEFLATED, 31, 9, Z_DEFAULT_STRATEGY);
  state.next_in = reinterpret_cast<Bytef*>(lines.data());
  state.avail_in = static_cast<uInt>(lines.size());
  state.next_out = reinterpret_cast<Bytef*>(packed.data());
  state.avail_out = static_cast<uInt>(packed.size());
  deflate(&state, Z_FINISH);
  packed.resize(state.total_out);
  deflateEnd(&state);
  return repeated(packed, 20);
}

// An archive whose directory names one file twenty times.
std::string npz() {
  std::string archive = zipArchive({{"x.npy", npyArray("'<u2'", "(50000000,)", zeros()), true}});
  const std::size_t directory = archive.find("PK\1\2"), end = archive.rfind("PK\5\6");
  const std::string entry = archive.substr(directory, end - directory), count = bytesOf(std::uint16_t{20});
  std::string tail = archive.substr(end);
  tail.replace(8, 2, count).replace(10, 2, count);
  tail.replace(12, 4, bytesOf(static_cast<std::uint32_t>(20 * entry.size())));
  return archive.substr(0, directory) + repeated(entry, 20) + tail;
}

std::string aedat4(aedat::Compression compression, std::size_t part_bytes, std::size_t count) {
  aedat::FileHeader header;
  header.compression = static_cast<std::int32_t>(compression);
  header.description =
      aedat::descriptionsXml({{0, "events", "EVTS", "a", {64, 48}}}, aedat::compressionName(compression));
  std::size_t position_at = 0;
  std::string packed;
  aedat::pack(compression, std::string(part_bytes, '\0'), packed);
  const std::string packet =
      bytesOf(std::int32_t{0}) + bytesOf(static_cast<std::int32_t>(packed.size())) + packed;
  return std::string(aedat::kMagic) + aedat::encodeHeader(header, position_at) + repeated(packet, count);
}

std::string aedat4Lz4() {
  return aedat4(aedat::Compression::Lz4, 200'000'000, 3);
}
std::string aedat4Zstd() {
  return aedat4(aedat::Compression::Zstd, kPart_bytes, 300);
}

void writeDatabase(const fs::path& path, const std::string& sql) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  if (sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    throw std::runtime_error(sqlite3_errmsg(database));
  sqlite3_close(database);
}

constexpr const char* kTopics =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, q TEXT);"
    "INSERT INTO topics VALUES(1, '/imu', 'sensor_msgs/msg/Imu', 'cdr', '');";

void computedMessages(const fs::path& path) {
  writeDatabase(path,
                std::string(kTopics) +
                    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
                    "data BLOB GENERATED ALWAYS AS (zeroblob(timestamp * 0 + 300000000)) VIRTUAL);"
                    "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 200) "
                    "INSERT INTO messages(topic_id, timestamp) SELECT 1, i FROM n");
}

void packedMessages(const fs::path& path) {
  std::vector<RosMessage> messages(300, {0, 1'000'000'000, zstdZeros()});
  writeSqliteBag(path, {{"/imu", "sensor_msgs/msg/Imu"}}, messages);
}

// Short rows take the rest from the column's default value.
void defaultMessages(const fs::path& path) {
  writeDatabase(path,
                std::string(kTopics) +
                    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER);"
                    "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 100000) "
                    "INSERT INTO messages SELECT i, 1, i FROM n;"
                    "ALTER TABLE messages ADD COLUMN data BLOB DEFAULT x'" +
                    std::string(600'000, '0') + "'");
}

// The same in a list: `columns` are those of the table's rows, and `added` is another column with a long
// default value.
void defaultRows(const fs::path& path, const std::string& table, const std::string& columns,
                 const std::string& values, const std::string& added) {
  const std::string long_text(500'000, 'a');
  writeDatabase(path,
                "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data "
                "BLOB); CREATE TABLE " +
                    table + "(id INTEGER PRIMARY KEY, " + columns +
                    "); WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 9000) "
                    "INSERT INTO " +
                    table + " SELECT i, " + values + " FROM n; ALTER TABLE " + table + " ADD COLUMN " +
                    added + " TEXT DEFAULT '" + long_text + "'");
}
void defaultNames(const fs::path& path) {
  defaultRows(path, "topics", "type TEXT, serialization_format TEXT", "'sensor_msgs/msg/Imu', 'cdr'", "name");
}
void defaultDefinitions(const fs::path& path) {
  defaultRows(path, "message_definitions", "topic_type TEXT, encoding TEXT", "'a/msg/B' || i, 'ros2msg'",
              "encoded_message_definition");
  writeDatabase(path, kTopics);
}

using Write = void (*)(const fs::path&);
using Bytes = std::string (*)();

}  // namespace

class TestBombs : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  static FileCost inspected(const fs::path& path) {
    return costOf([&] {
      const Inspection inspection = inspectRecording(*openRecording(path));
      std::string said = "read";
      for (const RecordingFault& fault : inspection.faults) said += "; " + fault.text;
      return said;
    });
  }

 private slots:
  void packedFiles_costLittle_data() {
    QTest::addColumn<Bytes>("bytes");
    QTest::addColumn<QString>("name");
    QTest::addColumn<QString>("says");
    const auto row = [](const char* what, Bytes bytes, const char* name, const char* says) {
      QTest::newRow(what) << bytes << QString(name) << QString(says);
    };
    const char* const kTooMuch = "unpacks to more than \\d+ MB, although it has only \\d+ kB";
    row("bz2 chunks of a bag", bz2Bag, "a.bag", kTooMuch);
    row("lz4 chunk of a bag", lz4Bag, "a.bag", "states 300000000 bytes .* implausible");
    row("connections of a bag", bagOfConnections, "a.bag", "lists 30000 topics or connections");
    row("zstd chunks of MCAP", mcapOfChunks, "a.mcap", kTooMuch);
    row("channels of MCAP", mcapOfChannels, "a.mcap", "lists 65000 topics or connections");
    row("definitions of MCAP", mcapOfDefinitions, "a.mcap", "definitions of its messages are too large");
    row("zstd file", zstdFile, "a.mcap.zstd", kTooMuch);
    row("gz text", gzText, "events.txt.gz", kTooMuch);
    row("npz", npz, "a.npz", kTooMuch);
    row("AEDAT4, lz4", aedat4Lz4, "a.aedat4", "cannot be unpacked");
    row("AEDAT4, zstd", aedat4Zstd, "a.aedat4", kTooMuch);
  }
  void packedFiles_costLittle() {
    QFETCH(Bytes, bytes);
    QFETCH(QString, name);
    QFETCH(QString, says);
    const fs::path path = folder_.filePath(name).toStdString();
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes();
    const FileCost cost = inspected(path);
    fs::remove(path);
    VERIFY_COST(cost, says);
  }

  void databases_costLittle_data() {
    QTest::addColumn<Write>("write");
    QTest::addColumn<QString>("says");
    QTest::newRow("generated column") << Write{computedMessages} << "messages computes its values";
    QTest::newRow("zstd messages") << Write{packedMessages} << "unpacks to more than";
    QTest::newRow("default value") << Write{defaultMessages} << "unpacks to more than";
    QTest::newRow("default names") << Write{defaultNames} << "lists more than .* 64 MB of their texts";
    QTest::newRow("default definitions") << Write{defaultDefinitions} << "more than 64 MB of their texts";
  }
  void databases_costLittle() {
    QFETCH(Write, write);
    QFETCH(QString, says);
    const fs::path path = folder_.filePath("a.db3").toStdString();
    fs::remove(path);
    write(path);
    VERIFY_COST(inspected(path), says);
  }

  void hdf5Files_costLittle_data() {
    QTest::addColumn<QString>("script");
    QTest::addColumn<QString>("says");
    const QString columns =
        "e = f.create_group('events'); n = 65536\n"
        "for k, d in (('x', 'u2'), ('y', 'u2'), ('p', 'u1'), ('t', 'i8')):\n"
        "  e.create_dataset(k, data=np.arange(n).astype(d) % 50, chunks=(n,), compression='gzip', "
        "maxshape=(None,))\n";
    QTest::newRow("gzip chunk")
        << columns + "e['x'].id.write_direct_chunk((0,), zlib.compress(bytes(800000000), 9))\n"
        << "it unpacks to more than it states";
    QTest::newRow("rows without chunks") << columns + "for k in e: e[k].resize((10**10,))\n"
                                         << "unpacks to more than";
    QTest::newRow("nested groups") << "g = f\nfor i in range(3000): g = g.create_group('g')\n"
                                   << "nested too deeply";
  }
  void hdf5Files_costLittle() {
    QFETCH(QString, script);
    QFETCH(QString, says);
    QProcess python;
    const QString path = folder_.filePath("a.h5");
    python.start("/usr/bin/python3", {"-c", "import zlib, h5py, numpy as np\nwith h5py.File('" + path +
                                                "', 'w') as f:\n  exec('''" + script + "''')"});
    python.waitForFinished(120'000);
    if (python.exitCode() != 0) QSKIP("h5py is not installed");
    VERIFY_COST(inspected(path.toStdString()), says);
  }

  // Pictures without any noise, as from a lens with its cap on, are small and right.
  void evenPictures_areRead() {
    constexpr std::size_t kPicture_bytes = 640 * 480;
    std::string records;
    BagBuilder bag("bz2");
    const std::uint32_t camera =
        bag.addConnection("/camera", "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743");
    for (int i = 0; i < 60; ++i) {
      const std::int64_t time_ns = 1'000'000'000 + i * 33'000'000LL;
      bag.message(camera, time_ns,
                  bytesOf(std::uint32_t{0}) + timeBytes(time_ns) + sized("camera") +
                      bytesOf(std::uint32_t{480}) + bytesOf(std::uint32_t{640}) + sized("mono8") +
                      bytesOf(std::uint8_t{0}) + bytesOf(std::uint32_t{640}) +
                      sized(std::string(kPicture_bytes, '\0')));
    }
    const fs::path path = folder_.filePath("even.bag").toStdString();
    std::ofstream(path, std::ios::binary) << bag.finished();
    QVERIFY(fs::file_size(path) * 1000 < 60 * kPicture_bytes);
    const Inspection inspection = inspectRecording(*openRecording(path));
    QVERIFY(inspection.faults.empty());
    QCOMPARE(inspection.streams.at(0).info.messages, std::uint64_t{60});
  }
};

EVICAL_TEST(TestBombs)
#include "tst_bombs.moc"
