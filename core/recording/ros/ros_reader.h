// ROS recordings: bags of ROS 1, and MCAP and sqlite3 files of ROS 2, alone or as a folder of several
// files that form one recording.
#pragma once

#include "core/recording/recording_reader.h"
#include "core/recording/ros/message_source.h"
#include "core/recording/ros/topic_streams.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical {

class RosReader : public RecordingReader {
 public:
  // A file, or a folder with metadata.yaml or such files.
  explicit RosReader(const std::filesystem::path& path);

  const std::vector<StreamInfo>& streams() const override { return topics_.streams(); }
  void select(const std::vector<std::size_t>& streams) override { topics_.select(path_, streams); }
  bool read(Packet& packet) override;
  bool follow(const std::shared_ptr<Growth>& growth) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return topics_.faults(); }
  std::string format() const override { return format_; }

 private:
  bool openFile(std::size_t index);
  void matchTopics();
  void lookIntoFile();
  bool nextFile();
  ros::FaultSink sink(const std::filesystem::path& file);

  std::string path_, format_;
  std::vector<std::filesystem::path> files_;
  ros::TopicStreams topics_;
  std::unique_ptr<ros::MessageSource> source_;  // the current file
  std::vector<std::size_t> streams_of_topics_;  // of source_
  std::size_t file_ = 0;
  bool started_ = false;
};

}  // namespace evical
