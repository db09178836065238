#include "tests/core/recording/ros/ros2_builder.h"
#include "core/base/time.h"

#include <sqlite3.h>

#include <algorithm>
#include <stdexcept>

namespace evical::test {
namespace {

constexpr std::string_view kRos2BuilderMagic("\x89MCAP0\r\n", 8);

template <class Number>
std::string bytesOfRos2Builder(Number value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string sized(std::string_view content) {
  return bytesOfRos2Builder(static_cast<std::uint32_t>(content.size())) + std::string(content);
}

class Cdr {
 public:
  explicit Cdr(bool big_endian = false) : big_endian_(big_endian) {}

  template <class Number>
  void add(Number value) {
    while (body_.size() % sizeof value != 0) body_.push_back('\0');
    std::string bytes = bytesOfRos2Builder(value);
    if (big_endian_) std::reverse(bytes.begin(), bytes.end());
    body_ += bytes;
  }
  void addTime(std::int64_t time_ns) {
    add(static_cast<std::int32_t>(time_ns / kSecond_ns));
    add(static_cast<std::uint32_t>(time_ns % kSecond_ns));
  }
  void addHeader(std::int64_t stamp_ns) {
    addTime(stamp_ns);
    add(std::uint32_t{7});
    body_.append("camera\0", 7);
  }
  std::string message() const { return std::string(big_endian_ ? "\0\0\0\0" : "\0\1\0\0", 4) + body_; }

 private:
  bool big_endian_;
  std::string body_;
};

std::string chunkRecord(const std::string& records) {
  const std::string content = bytesOfRos2Builder(std::uint64_t{0}) + bytesOfRos2Builder(std::uint64_t{0}) +
                              bytesOfRos2Builder(std::uint64_t{records.size()}) +
                              bytesOfRos2Builder(std::uint32_t{0}) + sized("") +
                              bytesOfRos2Builder(std::uint64_t{records.size()}) + records;
  return mcapRecord(0x06, content);
}

void require(bool fine, sqlite3* database) {
  if (!fine) throw std::runtime_error(sqlite3_errmsg(database));
}

void run(sqlite3* database, const std::string& sql) {
  require(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK, database);
}

}  // namespace

std::string cdrEvents(Resolution resolution_px, const std::vector<Event>& events, bool big_endian) {
  Cdr cdr(big_endian);
  cdr.addHeader(events.empty() ? 0 : events.front().time_ns);
  cdr.add(static_cast<std::uint32_t>(resolution_px.height_px));
  cdr.add(static_cast<std::uint32_t>(resolution_px.width_px));
  cdr.add(static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events) {
    cdr.add(event.x_px);
    cdr.add(event.y_px);
    cdr.addTime(event.time_ns);
    cdr.add(static_cast<std::uint8_t>(event.brighter ? 1 : 0));
  }
  return cdr.message();
}

std::string cdrImu(const ImuSample& sample) {
  Cdr cdr;
  cdr.addHeader(sample.time_ns);
  const auto addZeros = [&cdr](int count) {
    for (int i = 0; i < count; ++i) cdr.add(0.0);
  };
  addZeros(4 + 9);
  for (const double value : sample.angular_rate_rad_s) cdr.add(value);
  addZeros(9);
  for (const double value : sample.specific_force_m_s2) cdr.add(value);
  addZeros(9);
  return cdr.message();
}

std::string mcapRecord(std::uint8_t op, std::string_view content) {
  return bytesOfRos2Builder(op) + bytesOfRos2Builder(std::uint64_t{content.size()}) + std::string(content);
}

std::string mcapFile(const std::vector<RosTopic>& topics, const std::vector<RosMessage>& messages,
                     std::size_t chunk_messages) {
  std::string file = std::string(kRos2BuilderMagic) + mcapRecord(0x01, sized("ros2") + sized("test"));
  std::string records;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(i + 1);
    records +=
        mcapRecord(0x03, bytesOfRos2Builder(id) + sized(topics[i].type) + sized("ros2msg") + sized(""));
    records += mcapRecord(0x04, bytesOfRos2Builder(id) + bytesOfRos2Builder(id) + sized(topics[i].name) +
                                    sized(topics[i].encoding) + sized(""));
  }
  std::size_t gathered = 0;
  for (const RosMessage& message : messages) {
    records +=
        mcapRecord(0x05, bytesOfRos2Builder(static_cast<std::uint16_t>(message.topic + 1)) +
                             bytesOfRos2Builder(std::uint32_t{0}) + bytesOfRos2Builder(message.time_ns) +
                             bytesOfRos2Builder(message.time_ns) + message.bytes);
    if (chunk_messages == 0 || ++gathered < chunk_messages) continue;
    file += chunkRecord(records);
    records.clear();
    gathered = 0;
  }
  file += chunk_messages != 0 && !records.empty() ? chunkRecord(records) : records;
  const std::string footer = bytesOfRos2Builder(std::uint64_t{0}) + bytesOfRos2Builder(std::uint64_t{0}) +
                             bytesOfRos2Builder(std::uint32_t{0});
  return file + mcapRecord(0x0F, bytesOfRos2Builder(std::uint32_t{0})) + mcapRecord(0x02, footer) +
         std::string(kRos2BuilderMagic);
}

void writeSqliteBag(const std::filesystem::path& path, const std::vector<RosTopic>& topics,
                    const std::vector<RosMessage>& messages, bool with_index) {
  std::filesystem::remove(path);
  sqlite3* database = nullptr;
  require(sqlite3_open(path.c_str(), &database) == SQLITE_OK, database);
  run(database,
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
      "data BLOB NOT NULL); BEGIN");
  if (with_index) run(database, "CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  for (std::size_t i = 0; i < topics.size(); ++i) {
    run(database, "INSERT INTO topics VALUES(" + std::to_string(i + 1) + ",'" + topics[i].name + "','" +
                      topics[i].type + "','" + topics[i].encoding + "','')");
  }
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?,?,?)", -1, &insert,
                     nullptr);
  for (const RosMessage& message : messages) {
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(message.topic + 1));
    sqlite3_bind_int64(insert, 2, message.time_ns);
    sqlite3_bind_blob64(insert, 3, message.bytes.data(), message.bytes.size(), SQLITE_STATIC);
    require(sqlite3_step(insert) == SQLITE_DONE, database);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  run(database, "COMMIT");
  sqlite3_close(database);
}

}  // namespace evical::test
