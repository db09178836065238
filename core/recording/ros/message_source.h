// One file of a ROS recording as its messages, for any container.
#pragma once

#include "core/recording/ros/topic_streams.h"

#include <cstddef>
#include <cstdint>
#include <functional>
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
  std::string_view bytes;  // until the next call
};

// Takes a fault of the file: kind and text, as in RecordingFault.
using FaultSink = std::function<void(FaultKind kind, const std::string& text)>;

// Constructors throw CalibrationError (BadInput) if nothing can be read; what is lost
// later goes to their FaultSink.
class MessageSource {
 public:
  virtual ~MessageSource() = default;
  virtual const char* format() const = 0;                      // "mcap", "rosbag"
  virtual const std::vector<SourceTopic>& topics() const = 0;  // may grow while a damaged file is read
  virtual bool isIndexed() const = 0;                          // skips parts in which nothing wanted is
  // All if never called. While messages are read this is a hint: others may still come.
  virtual void want(std::vector<bool> topics) = 0;
  virtual bool next(SourceMessage& message) = 0;  // false at the end
  virtual void rewind() = 0;
  virtual std::string place() const = 0;  // of the last message, for people: "at byte 17"
  virtual double fractionRead() const = 0;
};

}  // namespace evical::ros
