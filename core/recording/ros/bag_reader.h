// ROS 1 bags, format 2.0, chunk by chunk: memory is that of the largest chunk. A damaged bag is read as far
// as it is whole, and what is missing is among the faults.
#pragma once

#include "core/recording/recording_reader.h"
#include "core/recording/ros/bag_records.h"
#include "core/recording/ros/topic_streams.h"

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace evical {

class BagReader : public RecordingReader {
 public:
  explicit BagReader(const std::filesystem::path& path);

  const std::vector<StreamInfo>& streams() const override { return topics_.streams(); }
  void select(const std::vector<std::size_t>& streams) override { topics_.select(path_, streams); }
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return topics_.faults(); }
  std::string format() const override { return "rosbag"; }

 private:
  enum class RecordState {
    Whole,
    End,
    Cut,      // its header is whole, its data go beyond the file's end
    Damaged,  // not even that
  };

  // A record of the file: its header, and where its data lie.
  struct FileRecord {
    rosbag::RecordHeader header;  // views into header_bytes_
    std::uint64_t data_position = 0;
    std::uint32_t data_size = 0;
    std::uint64_t end() const { return data_position + data_size; }
  };
  // A connection id, and the chunk in which its first message lies.
  struct Connection {
    std::size_t stream = 0;
    std::uint64_t first_chunk = 0;
  };

  bool readBytes(std::uint64_t position, std::uint64_t count, std::string& bytes);
  RecordState readRecord(std::uint64_t position, FileRecord& record);
  void loadChunk(std::uint64_t position, const FileRecord& record);
  std::uint64_t scanForChunk(std::uint64_t from);
  std::uint64_t recordAfter(std::uint64_t position, RecordState state, const FileRecord& record,
                            std::uint64_t& chunk_data);

  void listStreams();
  bool listFromIndex(std::uint64_t index_position, std::uint32_t connections, std::uint32_t chunks);
  void listByScan();
  void addConnection(std::uint32_t id, const rosbag::ConnectionData& data);
  void addChunkInfo(const FileRecord& record);
  void lookIntoChunk(std::uint64_t position);
  void lookIntoFirstMessages();

  bool wanted(std::uint32_t connection) const;
  bool chunkIsWanted(std::uint64_t position) const;
  std::uint64_t indexedChunkAfter(std::uint64_t position) const;
  bool nextChunk();
  void reportDamage(std::uint64_t position, RecordState state);
  bool nextMessage(Packet& packet);
  void addFault(FaultKind kind, const std::string& text) { topics_.addFault("", kind, text); }

  std::string path_;
  std::ifstream file_;
  std::uint64_t file_size_ = 0;
  std::uint64_t position_ = 0;    // of the next record to read
  std::uint64_t chunk_data_ = 0;  // where those of the last chunk begin
  ros::TopicStreams topics_;
  std::unordered_map<std::uint32_t, Connection> connections_;
  std::map<std::uint64_t, std::vector<std::uint32_t>> chunk_connections_;  // from the chunk infos
  std::string header_bytes_, file_bytes_, chunk_;
  std::uint64_t chunk_position_ = 0;  // in the file
  std::size_t chunk_offset_ = 0;      // of the next record in the chunk
};

}  // namespace evical
