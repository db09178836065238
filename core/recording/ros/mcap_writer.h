// MCAP files as ROS 2 records them (profile ros2, CDR), with the summary and indexes
// for random access.
#pragma once

#include "core/recording/recording_writer.h"
#include "core/recording/ros/ros_writer.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace evical {

class McapWriter : public ros::RosWriter {
 public:
  McapWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
             McapCompression compression);

  void finish() override;
  void flush() override;

 private:
  // Channel of the stream of the same number; its id is also its schema's.
  struct Channel {
    bool announced = false;                                      // its record is in a chunk
    std::uint64_t messages = 0;                                  // in the file
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // of the chunk: time, offset in it
  };
  struct ChunkInfo {
    std::uint64_t position = 0, size = 0;  // of the record in the file
    std::uint64_t first_ns = 0, last_ns = 0;
    std::string index_offsets;  // u16 channel, u64 position, ...
    std::uint64_t index_bytes = 0;
    std::uint64_t packed_bytes = 0, plain_bytes = 0;
  };

  void appendMessage(std::size_t stream, std::uint32_t sequence, std::int64_t time_ns,
                     std::string_view message) override;
  void announce(std::size_t stream);
  void flushChunk();
  void appendIndexes(ChunkInfo& chunk);
  void appendSummary();
  const char* compressionName() const;
  std::string schemaRecord(std::size_t stream) const;
  std::string channelRecord(std::size_t stream) const;
  std::string chunkIndexRecord(const ChunkInfo& chunk) const;
  std::string statisticsRecord() const;

  PartFile file_;
  McapCompression compression_;
  std::vector<Channel> channels_;
  std::vector<ChunkInfo> chunks_;
  std::string chunk_, packed_;
};

}  // namespace evical
