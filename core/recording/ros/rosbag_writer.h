// ROS 1 bags, format 2.0, with all records that random access needs.
#pragma once

#include "core/recording/part_file.h"
#include "core/recording/recording_writer.h"

#include <cstdint>
#include <string>

namespace evical {

class RosbagWriter : public RecordingWriter {
 public:
  RosbagWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams, bool lz4);

  void write(std::size_t stream, EventSpan events) override;
  void write(std::size_t stream, std::span<const ImuSample> samples) override;
  void finish() override;

 private:
  struct IndexEntry {
    std::int64_t time_ns;
    std::uint32_t offset;  // of the message record in the chunk
  };
  // A stream is a connection of the same number.
  struct Stream {
    StreamInfo info;
    std::uint32_t sequence = 0;
    bool announced = false;         // its connection record is in a chunk
    std::vector<Event> events;      // of the message being gathered
    std::vector<IndexEntry> index;  // of the chunk being gathered
  };
  struct ChunkInfo {
    std::uint64_t position;
    std::int64_t first_ns, last_ns;
    std::string counts;  // u32 connection, u32 messages, ...
    std::uint32_t connections;
  };

  void flushEvents(std::size_t stream);
  void appendMessage(std::size_t stream, std::int64_t time_ns);  // message_
  void flushChunk();
  void appendIndex(ChunkInfo& chunk);
  std::string bagHeader(std::uint64_t index_position) const;
  std::string connectionRecord(std::size_t stream) const;
  void requireTime(std::int64_t time_ns) const;
  Stream& checkedStream(std::size_t stream, StreamType type);

  std::string path_;
  PartFile file_;
  bool lz4_;
  std::vector<Stream> streams_;
  std::vector<ChunkInfo> chunks_;
  std::string message_, chunk_, compressed_;
};

}  // namespace evical
