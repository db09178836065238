// The records of a ROS 1 bag, format 2.0 (wiki.ros.org/Bags/Format/2.0), and the compression of its chunks.
#pragma once

#include "core/recording/ros/compression.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace evical::rosbag {

inline constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

enum class Op : std::uint8_t {
  Message = 2,
  BagHeader = 3,
  IndexData = 4,
  Chunk = 5,
  ChunkInfo = 6,
  Connection = 7,
};

// The fields of any record's header; absent ones are 0 or empty. Views
// point into the given bytes.
struct RecordHeader {
  std::uint8_t op = 0;
  std::uint32_t connection = 0;
  std::uint32_t size = 0;                               // of a chunk, uncompressed
  std::uint32_t connection_count = 0, chunk_count = 0;  // of the bag
  std::uint64_t index_position = 0, chunk_position = 0;
  std::int64_t time_ns = 0;
  std::string_view compression, topic;

  bool is(Op other) const { return op == static_cast<std::uint8_t>(other); }
};

// False if the bytes are not a list of fields with an op.
bool parseRecordHeader(std::string_view bytes, RecordHeader& header);

// Content of a connection record's data.
struct ConnectionData {
  std::string_view topic, type, md5, definition, publisher;
};
ConnectionData parseConnectionData(std::string_view bytes);

// Replaces `output` by the chunk's content of `size` bytes.
ros::Unpacked decompressChunk(std::string_view compression, std::string_view data, std::uint32_t size,
                              std::string& output);

}  // namespace evical::rosbag
