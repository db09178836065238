#include "core/recording/ros/ros_writer.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/ros/image_messages.h"
#include "core/recording/ros/ros_messages.h"

#include <fmt/format.h>

namespace evical::ros {
namespace {

constexpr std::int64_t kMessageSpan_ns = 10'000'000;
constexpr std::size_t kMessageEvents = 200'000;

}  // namespace

RosWriter::RosWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
                     Serialization serialization, std::int64_t seconds_end)
    : path_(path.string()), serialization_(serialization), seconds_end_(seconds_end) {
  for (const StreamInfo& stream : streams) {
    const bool events = stream.type == StreamType::Events;
    if (!events && stream.type != StreamType::Imu && stream.type != StreamType::Frames) {
      throw badInput(path_, fmt::format("stream {} has neither events, IMU samples nor frames", stream.name));
    }
    if (events && !stream.resolution_px.known()) {
      throw badInput(path_, fmt::format("the resolution of stream {} is missing", stream.name));
    }
    streams_.push_back({stream, 0, {}});
  }
}

const MessageType& RosWriter::messageType(std::size_t stream) const {
  const Stream& of = streams_[stream];
  if (of.info.type == StreamType::Events) return eventArrayType(serialization_);
  if (of.info.type == StreamType::Imu) return imuType(serialization_);
  return of.packed ? packedImageType(serialization_) : imageType(serialization_);
}

void RosWriter::write(std::size_t stream, EventSpan events) {
  std::vector<Event>& gathered = checkedStream(stream, StreamType::Events).events;
  for (const Event& event : events) {
    requireTime(event.time_ns);
    // A step back also starts a message: readers sort within one.
    const bool full = !gathered.empty() && (event.time_ns < gathered.back().time_ns ||
                                            event.time_ns - gathered.front().time_ns >= kMessageSpan_ns ||
                                            gathered.size() >= kMessageEvents);
    if (full) flushEvents(stream);
    gathered.push_back(event);
  }
}

void RosWriter::write(std::size_t stream, std::span<const ImuSample> samples) {
  Stream& target = checkedStream(stream, StreamType::Imu);
  for (const ImuSample& sample : samples) {
    requireTime(sample.time_ns);
    message_.clear();
    encodeImu(sample, target.sequence, serialization_, message_);
    appendMessage(stream, target.sequence++, sample.time_ns, message_);
  }
}

void RosWriter::writeFrame(std::size_t stream, const Frame& frame) {
  Stream& target = checkedStream(stream, StreamType::Frames);
  requireTime(frame.time_ns);
  if (target.sequence == 0) target.packed = frame.format == FrameFormat::Encoded;
  message_.clear();
  const bool encoded = target.packed ? encodePackedImage(frame, target.sequence, serialization_, message_)
                                     : encodeImage(frame, target.sequence, serialization_, message_);
  if (!encoded)
    throw calibrationFailed(
        path_, fmt::format("a frame of {} fits no message of sensor_msgs", target.info.name),
        "Use JPEG, PNG or plain pixels; all frames of a stream must be either files or plain pixels");
  appendMessage(stream, target.sequence++, frame.time_ns, message_);
}

std::vector<std::string> RosWriter::streamNames() const {
  std::vector<std::string> names;
  for (const Stream& stream : streams_) names.push_back(stream.info.name);
  return names;
}

void RosWriter::flushEvents() {
  for (std::size_t i = 0; i < streams_.size(); ++i) flushEvents(i);
}

void RosWriter::flushEvents(std::size_t stream) {
  Stream& source = streams_[stream];
  if (source.events.empty()) return;
  message_.clear();
  encodeEventArray(source.events, source.sequence, source.info.resolution_px, serialization_, message_);
  appendMessage(stream, source.sequence++, source.events.back().time_ns, message_);
  source.events.clear();
}

void RosWriter::requireTime(std::int64_t time_ns) const {
  if (time_ns >= 0 && time_ns / kSecond_ns < seconds_end_) return;
  throw calibrationFailed(path_, fmt::format("a ROS recording cannot represent the time {} ns", time_ns),
                          fmt::format("Its times range from 0 to {} s", seconds_end_));
}

RosWriter::Stream& RosWriter::checkedStream(std::size_t stream, StreamType type) {
  Stream& checked = streams_.at(stream);
  if (checked.info.type == type) return checked;
  throw calibrationFailed(path_,
                          fmt::format("stream {} was given samples of another type", checked.info.name));
}

}  // namespace evical::ros
