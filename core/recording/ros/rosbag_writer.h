// ROS 1 bags, format 2.0, with all records for random access.
#pragma once

#include "core/recording/recording_writer.h"
#include "core/recording/ros/ros_writer.h"

#include <cstdint>
#include <string>

namespace evical {

class RosbagWriter : public ros::RosWriter {
 public:
  RosbagWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams, bool lz4);

  void finish() override;
  void flush() override;

 private:
  struct IndexEntry {
    std::int64_t time_ns;
    std::uint32_t offset;  // of the message record in the chunk
  };
  // Connection of the stream of the same number.
  struct Connection {
    bool announced = false;         // its connection record is in a chunk
    std::vector<IndexEntry> index;  // of the current chunk
  };
  struct ChunkInfo {
    std::uint64_t position;
    std::int64_t first_ns, last_ns;
    std::string counts;  // u32 connection, u32 messages, ...
    std::uint32_t connections;
  };

  void appendMessage(std::size_t stream, std::uint32_t sequence, std::int64_t time_ns,
                     std::string_view message) override;
  void announce(std::size_t stream);
  void flushChunk();
  void appendIndex(ChunkInfo& chunk);
  std::string bagHeader(std::uint64_t index_position) const;
  std::string connectionRecord(std::size_t stream) const;

  PartFile file_;
  bool lz4_;
  std::vector<Connection> connections_;
  std::vector<ChunkInfo> chunks_;
  std::string chunk_, compressed_;
};

}  // namespace evical
