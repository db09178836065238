#include "core/recording/ros/bag_records.h"

#include "core/recording/byte_cursor.h"

namespace evical::rosbag {
namespace {

// Iterates over "u32 length, name=value" fields; a value may contain any byte, so the first '=' splits.
template <class Visitor>
bool forEachField(std::string_view bytes, Visitor&& visit) {
  ByteCursor cursor(bytes);
  while (!cursor.atEnd()) {
    const std::string_view field = cursor.sized();
    const std::size_t equals = field.find('=');
    if (!cursor.ok() || equals == std::string_view::npos) return false;
    visit(field.substr(0, equals), field.substr(equals + 1));
  }
  return true;
}

template <class Number>
Number numberIn(std::string_view value) {
  return ByteCursor(value).number<Number>();
}

std::int64_t timeIn(std::string_view value) {
  ByteCursor cursor(value);
  const std::int64_t seconds = cursor.number<std::uint32_t>();
  return seconds * 1'000'000'000 + cursor.number<std::uint32_t>();
}

}  // namespace

bool parseRecordHeader(std::string_view bytes, RecordHeader& header) {
  header = {};
  const bool whole = forEachField(bytes, [&](std::string_view name, std::string_view value) {
    if (name == "op") header.op = numberIn<std::uint8_t>(value);
    if (name == "conn") header.connection = numberIn<std::uint32_t>(value);
    if (name == "time") header.time_ns = timeIn(value);
    if (name == "size") header.size = numberIn<std::uint32_t>(value);
    if (name == "conn_count") header.connection_count = numberIn<std::uint32_t>(value);
    if (name == "chunk_count") header.chunk_count = numberIn<std::uint32_t>(value);
    if (name == "index_pos") header.index_position = numberIn<std::uint64_t>(value);
    if (name == "chunk_pos") header.chunk_position = numberIn<std::uint64_t>(value);
    if (name == "compression") header.compression = value;
    if (name == "topic") header.topic = value;
  });
  return whole && header.op != 0;
}

ConnectionData parseConnectionData(std::string_view bytes) {
  ConnectionData connection;
  forEachField(bytes, [&](std::string_view name, std::string_view value) {
    if (name == "topic") connection.topic = value;
    if (name == "type") connection.type = value;
    if (name == "md5sum") connection.md5 = value;
    if (name == "message_definition") connection.definition = value;
    if (name == "callerid") connection.publisher = value;
  });
  return connection;
}

ros::Unpacked decompressChunk(std::string_view compression, std::string_view data, std::uint32_t size,
                              std::string& output) {
  if (compression == "lz4") return ros::unpackLz4(data, size, output);
  if (compression == "bz2") return ros::unpackBz2(data, size, output);
  if (compression == "none") return ros::copyPlain(data, size, output);
  output.clear();
  return ros::Unpacked::Damaged;
}

}  // namespace evical::rosbag
