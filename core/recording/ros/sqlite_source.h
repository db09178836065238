// sqlite3 files of ROS 2 bags (.db3): read-only, message by message.
#pragma once

#include "core/recording/ros/message_source.h"
#include "core/recording/unpacking_limit.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

inline constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);

class SqliteSource : public MessageSource {
 public:
  SqliteSource(const std::filesystem::path& path, FaultSink sink);
  ~SqliteSource() override;

  const char* format() const override { return "rosbag2"; }
  const std::vector<SourceTopic>& topics() const override { return topics_; }
  bool isIndexed() const override { return false; }
  void want(std::vector<bool> topics) override { wanted_ = std::move(topics); }
  bool next(SourceMessage& message) override;
  void rewind() override;
  std::string place() const override;
  double fractionRead() const override;

 private:
  class Database;  // hide sqlite3
  class Statement;

  void open();
  void listTopics();
  std::map<std::string, std::string> definitions();
  void countMessages();
  bool hasTable(const char* name);
  void refuseComputed(const char* table);
  bool hasTimeIndex();
  void query();
  bool step();
  bool readOnBehindDamage(const std::string& reason);
  bool isCutOff(std::int64_t id, std::string_view bytes) const;
  bool handOut(SourceMessage& message);

  std::filesystem::path path_;
  FaultSink sink_;
  UnpackingLimit limit_;
  std::unique_ptr<Database> database_;
  std::unique_ptr<Statement> messages_;
  std::vector<SourceTopic> topics_;
  std::vector<bool> wanted_;
  std::map<std::int64_t, std::size_t> topic_of_id_;
  bool cut_ = false;                // shorter than its header states
  bool by_time_ = true;             // otherwise in the order of storage
  std::int64_t last_id_ = 0;        // of the messages read, the largest
  std::int64_t from_id_ = 0;        // begin of the query
  std::int64_t skip_ids_ = 1;       // step after a query without new messages
  std::int64_t largest_id_ = 0;     // of all messages
  std::int64_t last_whole_id_ = 0;  // before the first missing page
  std::uint64_t count_ = 0, read_ = 0;
  std::string unpacked_;
};

}  // namespace evical::ros
