// MCAP files, chunk by chunk: memory is that of the largest chunk. The intact part of a file that was cut or
// has no summary is read in sequence.
#pragma once

#include "core/recording/block_reader.h"
#include "core/recording/ros/mcap_records.h"
#include "core/recording/ros/message_source.h"
#include "core/recording/unpacking_limit.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace evical::ros {

class McapSource : public MessageSource {
 public:
  McapSource(const std::filesystem::path& path, FaultSink sink);

  const char* format() const override { return "mcap"; }
  const std::vector<SourceTopic>& topics() const override { return topics_; }
  bool isIndexed() const override { return !chunk_channels_.empty(); }
  void want(std::vector<bool> topics) override { wanted_ = std::move(topics); }
  bool next(SourceMessage& message) override;
  void rewind() override;
  bool follow(const std::shared_ptr<Growth>& growth) override;
  std::string place() const override;
  double fractionRead() const override;

 private:
  struct SchemaText {
    std::string name, definition;
  };
  struct Record {
    std::uint8_t op = 0;
    std::uint64_t position = 0, content = 0,
                  size = 0;  // begin of record and content, length of the content
    bool is(mcap::Op other) const { return op == static_cast<std::uint8_t>(other); }
    std::uint64_t end() const { return content + size; }
  };
  // A chunk whose channels may be determined by the indexes after it.
  struct PendingChunk {
    std::uint64_t position = 0;
    std::map<std::uint16_t, std::uint64_t> messages;
  };

  void goToBegin();
  bool readHead(std::uint64_t position, Record& record);
  bool readContent(const Record& record, std::string_view& content);
  bool listFromSummary();
  bool takeSummaryRecord(const Record& record, mcap::Statistics& statistics);
  void listByScan();
  void countPending(PendingChunk& chunk);
  void addSchema(std::string_view content);
  void addChannel(std::string_view content);
  void countMessage(std::string_view content);

  bool nextRecord(SourceMessage& message);
  bool nextOfChunk(SourceMessage& message);
  bool handOut(std::string_view content, SourceMessage& message);
  bool wanted(std::size_t topic) const { return topic >= wanted_.size() || wanted_[topic]; }
  bool chunkIsWanted(std::uint64_t position) const;
  bool loadChunk(const Record& record);
  void reportChunk(Unpacked result, const Record& record, const mcap::ChunkHead& head);
  void checkSum(const mcap::ChunkHead& head, const Record& record);
  std::uint64_t chunkAfter(std::uint64_t position);
  std::uint64_t scanForChunk(std::uint64_t from);
  void skipDamage(const Record& record);

  std::string path_;
  FaultSink sink_;
  RandomAccessFile file_;
  UnpackingLimit limit_;
  std::vector<SourceTopic> topics_;
  std::vector<bool> wanted_;
  std::unordered_map<std::uint16_t, SchemaText> schemas_;
  std::unordered_map<std::uint16_t, std::size_t> topic_of_channel_;
  std::map<std::uint64_t, std::vector<std::uint16_t>> chunk_channels_;  // from the chunk indexes
  std::uint64_t position_ = 0;                                          // of the next record
  std::uint64_t record_position_ = 0;                                   // of the last one read
  std::string unpacked_;
  std::string_view chunk_;                    // remaining records of the current chunk
  std::size_t chunk_size_ = 0;                // of all its records
  bool chunk_is_cut_ = false;                 // and its last record, which was reported
  std::vector<std::string> without_schema_;   // topics
  std::set<std::uint16_t> unknown_channels_;  // of messages
  std::size_t definitions_bytes_ = 0;         // of all topics
  bool closed_ = false;                       // the file is complete
  bool ended_ = false;
};

}  // namespace evical::ros
