// One file of a ROS recording as a sequence of messages, for any container.
#pragma once

#include "core/recording/ros/topic_streams.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

struct SourceTopic {
  Topic topic;
  std::uint64_t messages = 0;  // 0 if unknown
};

struct SourceMessage {
  std::size_t topic = 0;  // index into MessageSource::topics()
  std::int64_t record_time_ns = 0;
  std::string_view bytes;  // valid until the next call
};

// Receives a fault of the file: kind and text, as in RecordingFault.
using FaultSink = std::function<void(FaultKind kind, const std::string& text)>;

// Constructors throw CalibrationError (BadInput) if nothing can be read; later losses
// are reported to their FaultSink.
class MessageSource {
 public:
  virtual ~MessageSource() = default;
  virtual const char* format() const = 0;                      // "mcap", "rosbag"
  virtual const std::vector<SourceTopic>& topics() const = 0;  // may grow while a damaged file is read
  virtual bool isIndexed() const = 0;                          // skips parts without selected topics
  // Default: all. A hint while messages are read: others may still be returned.
  virtual void want(std::vector<bool> topics) = 0;
  virtual bool next(SourceMessage& message) = 0;  // false at the end
  virtual void rewind() = 0;
  // As RecordingReader::follow.
  virtual bool follow(const std::shared_ptr<Growth>& /*growth*/) { return false; }
  virtual std::string place() const = 0;  // of the last message, for people: "at byte 17"
  virtual double fractionRead() const = 0;
};

}  // namespace evical::ros
