// Common parts of the writers of ROS recordings: grouping of events into messages, encoding, checks.
#pragma once

#include "core/recording/recording_writer.h"
#include "core/recording/ros/message_types.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

class RosWriter : public RecordingWriter {
 public:
  void write(std::size_t stream, EventSpan events) override;
  void write(std::size_t stream, std::span<const ImuSample> samples) override;
  void writeFrame(std::size_t stream, const Frame& frame) override;
  std::vector<std::string> streamNames() const override;

 protected:
  // Times must be within [0, seconds_end) s. Throws CalibrationError (BadInput) for streams other than
  // events, IMU samples and frames, and for events without a resolution.
  RosWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
            Serialization serialization, std::int64_t seconds_end);

  virtual void appendMessage(std::size_t stream, std::uint32_t sequence, std::int64_t time_ns,
                             std::string_view message) = 0;
  void flushEvents();  // of all streams

  std::size_t streamCount() const { return streams_.size(); }
  const StreamInfo& info(std::size_t stream) const { return streams_[stream].info; }
  const MessageType& messageType(std::size_t stream) const;

 private:
  struct Stream {
    StreamInfo info;
    std::uint32_t sequence = 0;
    std::vector<Event> events;  // of the message being gathered
    bool packed = false;        // frames are encoded files, like the first one
  };

  void flushEvents(std::size_t stream);
  void requireTime(std::int64_t time_ns) const;
  Stream& checkedStream(std::size_t stream, StreamType type);

  std::string path_;
  Serialization serialization_;
  std::int64_t seconds_end_;
  std::vector<Stream> streams_;
  std::string message_;
};

}  // namespace evical::ros
