// ROS 1 bags, format 2.0, chunk by chunk: memory is that of the largest chunk. The intact part of a damaged
// bag is read, and the missing parts are reported to the FaultSink.
#pragma once

#include "core/recording/block_reader.h"
#include "core/recording/ros/bag_records.h"
#include "core/recording/ros/message_source.h"
#include "core/recording/unpacking_limit.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace evical::ros {

class BagSource : public MessageSource {
 public:
  BagSource(const std::filesystem::path& path, FaultSink sink);

  const char* format() const override { return "rosbag"; }
  const std::vector<SourceTopic>& topics() const override { return topics_; }
  bool isIndexed() const override { return !chunk_connections_.empty(); }
  void want(std::vector<bool> topics) override { wanted_ = std::move(topics); }
  bool next(SourceMessage& message) override;
  void rewind() override;
  bool follow(const std::shared_ptr<Growth>& growth) override;
  std::string place() const override;
  double fractionRead() const override;

 private:
  enum class RecordState {
    Whole,
    End,
    Cut,      // its header is complete, its data exceed the file
    Damaged,  // its header is damaged
  };

  // A record of the file: its header, and the position of its data.
  struct FileRecord {
    rosbag::RecordHeader header;  // views into header_bytes_
    std::uint64_t data_position = 0;
    std::uint32_t data_size = 0;
    std::uint64_t end() const { return data_position + data_size; }
  };

  RecordState readRecord(std::uint64_t position, FileRecord& record);
  bool loadChunk(std::uint64_t position, const FileRecord& record);
  std::uint64_t scanForChunk(std::uint64_t from);
  std::uint64_t recordAfter(std::uint64_t position, RecordState state, const FileRecord& record,
                            std::uint64_t& chunk_data);

  void listTopics();
  bool listFromIndex(std::uint64_t index_position, std::uint32_t connections, std::uint32_t chunks);
  void listByScan();
  void listFromChunk(std::uint64_t position);
  void separatePublishers();
  void addConnection(const rosbag::RecordHeader& header, const rosbag::ConnectionData& data);
  void addChunkInfo(std::uint64_t chunk, std::string_view counts);

  bool wanted(std::uint32_t connection) const;
  bool chunkIsWanted(std::uint64_t position) const;
  std::uint64_t indexedChunkAfter(std::uint64_t position) const;
  void skipUnwantedChunks();
  bool nextChunk();
  bool nextOfChunk(SourceMessage& message);
  void reportDamage(std::uint64_t position, RecordState state);

  FaultSink sink_;
  RandomAccessFile file_;
  UnpackingLimit limit_;
  std::uint64_t position_ = 0;    // of the next record to read
  std::uint64_t chunk_data_ = 0;  // begin of the last chunk's data
  std::vector<SourceTopic> topics_;
  std::vector<std::string> publishers_;  // nodes, by topic
  std::vector<bool> wanted_;
  std::unordered_map<std::uint32_t, std::size_t> topic_of_connection_;
  std::map<std::uint64_t, std::vector<std::uint32_t>> chunk_connections_;  // from the chunk infos
  std::string header_bytes_, unpacked_;
  std::uint64_t chunk_position_ = 0;  // in the file
  std::string_view chunk_;            // remaining records of the current chunk
  std::size_t chunk_size_ = 0;        // of all its records
  bool chunk_is_cut_ = false;         // and its last record, which was reported
};

}  // namespace evical::ros
