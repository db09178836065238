// The records of an MCAP file (mcap.dev/spec): one byte of kind, u64 length, content.
#pragma once

#include "core/recording/ros/compression.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace evical::mcap {

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
inline constexpr std::uint64_t kRecordHead_bytes = 9;
inline constexpr std::uint64_t kFooter_bytes = kRecordHead_bytes + 20;

enum class Op : std::uint8_t {
  Header = 0x01,
  Footer = 0x02,
  Schema = 0x03,
  Channel = 0x04,
  Message = 0x05,
  Chunk = 0x06,
  MessageIndex = 0x07,
  ChunkIndex = 0x08,
  Statistics = 0x0B,
  SummaryOffset = 0x0E,
  DataEnd = 0x0F,
};

std::string record(Op op, std::string_view content);

// All views point into the content parsed. The parsers return false if the content does not fit.
struct Schema {
  std::uint16_t id = 0;  // 0: none
  std::string_view name, encoding, data;
};
bool parseSchema(std::string_view content, Schema& schema);

struct Channel {
  std::uint16_t id = 0, schema = 0;
  std::string_view topic, encoding;
};
bool parseChannel(std::string_view content, Channel& channel);

struct Message {
  std::uint16_t channel = 0;
  std::int64_t log_time_ns = 0;
  std::string_view data;
};
bool parseMessage(std::string_view content, Message& message);

// A chunk's fields before its records.
struct ChunkHead {
  std::uint64_t uncompressed_bytes = 0, records_bytes = 0;
  std::uint32_t crc = 0;  // of the uncompressed records; 0: none
  std::string_view compression;
  std::uint64_t size = 0;  // of this head
};
inline constexpr std::uint64_t kLargestChunkHead_bytes = 64;
bool parseChunkHead(std::string_view content, ChunkHead& head);
ros::Unpacked unpackChunk(std::string_view compression, std::string_view data, std::uint64_t size_bytes,
                          std::string& output);

// A chunk's position, and the channels of its messages.
struct ChunkIndex {
  std::uint64_t position = 0;
  std::vector<std::uint16_t> channels;
};
bool parseChunkIndex(std::string_view content, ChunkIndex& index);

// Channel and number of the messages in an index after a chunk.
struct MessageIndex {
  std::uint16_t channel = 0;
  std::uint64_t messages = 0;
};
bool parseMessageIndex(std::string_view content, MessageIndex& index);

struct Statistics {
  std::uint32_t channels = 0;
  std::map<std::uint16_t, std::uint64_t> messages;  // by channel
};
bool parseStatistics(std::string_view content, Statistics& statistics);

}  // namespace evical::mcap
