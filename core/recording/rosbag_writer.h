// ROS 1 bags, format 2.0, with index, as rosbag itself writes them.
#pragma once

#include "core/recording/output_file.h"
#include "core/recording/recording_writer.h"
#include "core/recording/ros_message.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

class RosbagWriter : public RecordingWriter {
 public:
  RosbagWriter(const std::filesystem::path& path, BagCompression compression);

  std::size_t addEventStream(const std::string& name, Resolution resolution_px) override;
  std::size_t addImuStream(const std::string& name) override;
  void write(std::size_t stream, EventSpan events) override;
  void write(std::size_t stream, const ImuSample& sample) override;
  void finish() override;

 private:
  struct IndexEntry {
    std::int64_t time_ns = 0;
    std::uint32_t offset = 0;  // of the record in the unpacked chunk
  };
  struct Stream {
    std::string topic;
    RosMessageType type;
    Resolution resolution_px;
    std::uint32_t sequence = 0;
    std::vector<Event> waiting;     // until they make a message
    std::vector<IndexEntry> index;  // of the current chunk
    bool written = false;           // its connection record, somewhere in the bag
  };
  struct ChunkInfo {
    std::uint64_t position = 0;
    std::int64_t start_ns = 0, end_ns = 0;
    std::vector<std::uint8_t> counts;  // (u32 connection, u32 messages)...
    std::uint32_t connections = 0;
  };

  void writeHeader(std::uint64_t index_position);
  void writeEventMessage(Stream& stream);
  void writeMessage(Stream& stream, std::int64_t time_ns);
  void writeChunk();
  void appendConnection(std::size_t stream, std::vector<std::uint8_t>& bytes) const;

  OutputFile file_;
  BagCompression compression_;
  std::vector<Stream> streams_;
  std::vector<ChunkInfo> chunks_;
  std::vector<std::uint8_t> chunk_, packed_, message_, scratch_;
};

}  // namespace evical
