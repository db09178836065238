#include "core/recording/ros/mcap_records.h"

#include "core/recording/byte_cursor.h"
#include "core/recording/recording_writer.h"

namespace evical::mcap {

std::string record(Op op, std::string_view content) {
  std::string bytes = numberBytes(op) + numberBytes(std::uint64_t{content.size()});
  return bytes.append(content);
}

bool parseSchema(std::string_view content, Schema& schema) {
  ByteCursor cursor(content);
  schema.id = cursor.number<std::uint16_t>();
  schema.name = cursor.sized();
  schema.encoding = cursor.sized();
  schema.data = cursor.sized();
  return cursor.ok();
}

bool parseChannel(std::string_view content, Channel& channel) {
  ByteCursor cursor(content);
  channel.id = cursor.number<std::uint16_t>();
  channel.schema = cursor.number<std::uint16_t>();
  channel.topic = cursor.sized();
  channel.encoding = cursor.sized();
  return cursor.ok();
}

bool parseMessage(std::string_view content, Message& message) {
  ByteCursor cursor(content);
  message.channel = cursor.number<std::uint16_t>();
  cursor.number<std::uint32_t>();  // sequence
  message.log_time_ns = static_cast<std::int64_t>(cursor.number<std::uint64_t>());
  cursor.number<std::uint64_t>();  // publish time
  message.data = cursor.take(cursor.remaining());
  return cursor.ok();
}

bool parseChunkHead(std::string_view content, ChunkHead& head) {
  ByteCursor cursor(content);
  cursor.number<std::uint64_t>();  // first and last time
  cursor.number<std::uint64_t>();
  head.uncompressed_bytes = cursor.number<std::uint64_t>();
  head.crc = cursor.number<std::uint32_t>();
  head.compression = cursor.sized();
  head.records_bytes = cursor.number<std::uint64_t>();
  head.size = cursor.position();
  return cursor.ok();
}

ros::Unpacked unpackChunk(std::string_view compression, std::string_view data, std::uint64_t size_bytes,
                          std::string& output) {
  if (compression == "lz4") return ros::unpackLz4(data, size_bytes, output);
  if (compression == "zstd") return ros::unpackZstd(data, size_bytes, output);
  if (compression.empty()) return ros::copyPlain(data, size_bytes, output);
  output.clear();
  return ros::Unpacked::Damaged;
}

bool parseChunkIndex(std::string_view content, ChunkIndex& index) {
  ByteCursor cursor(content);
  cursor.number<std::uint64_t>();  // first and last time
  cursor.number<std::uint64_t>();
  index.position = cursor.number<std::uint64_t>();
  cursor.number<std::uint64_t>();  // length
  ByteCursor offsets(cursor.sized());
  index.channels.clear();
  while (cursor.ok() && offsets.ok() && !offsets.atEnd()) {
    index.channels.push_back(offsets.number<std::uint16_t>());
    offsets.number<std::uint64_t>();
  }
  return cursor.ok() && offsets.ok();
}

bool parseMessageIndex(std::string_view content, MessageIndex& index) {
  constexpr std::uint64_t kEntry_bytes = 16;
  ByteCursor cursor(content);
  index.channel = cursor.number<std::uint16_t>();
  index.messages = cursor.sized().size() / kEntry_bytes;
  return cursor.ok();
}

bool parseStatistics(std::string_view content, Statistics& statistics) {
  ByteCursor cursor(content);
  cursor.number<std::uint64_t>();  // messages
  cursor.number<std::uint16_t>();  // schemas
  statistics.channels = cursor.number<std::uint32_t>();
  cursor.take(3 * sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t));  // other counts, first and last time
  ByteCursor counts(cursor.sized());
  statistics.messages.clear();
  while (cursor.ok() && counts.ok() && !counts.atEnd()) {
    const auto channel = counts.number<std::uint16_t>();
    statistics.messages[channel] = counts.number<std::uint64_t>();
  }
  return cursor.ok() && counts.ok();
}

}  // namespace evical::mcap
