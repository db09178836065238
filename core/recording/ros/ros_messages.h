// ROS messages with events and IMU samples, as the bytes of a recording.
#pragma once

#include "core/data/recording.h"
#include "core/recording/ros/message_cursor.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

// All replace their output; false, without output, if the bytes do not fit the stated sizes or a stamp is
// invalid. The resolution changes only if the message states one.
bool decodeEventArray(std::string_view message, Serialization serialization, std::vector<Event>& events,
                      Resolution& resolution_px);
// The array of 2015 and before: only events, with times in us.
bool decodeOldEventArray(std::string_view message, std::vector<Event>& events);
bool decodeImu(std::string_view message, Serialization serialization, std::vector<RawImuSample>& samples);

// event_camera_msgs/EventPacket: events in an encoding of the sensor.
struct EventPacket {
  std::int64_t stamp_ns = 0;  // of the host
  Resolution resolution_px;   // unknown if the message states none
  std::uint64_t sequence = 0;
  std::int64_t time_base_ns = 0;
  std::string_view encoding;
  bool big_endian = false;
  std::string_view events;  // both views point into the message
};
bool parseEventPacket(std::string_view message, Serialization serialization, EventPacket& packet);

// Both append to `message`, which is empty or has no padding. Times must be within the range of a ROS time:
// [0, 2^32) s for ROS 1, 2^31 for CDR. ROS 2 has no sequence number.
void encodeEventArray(EventSpan events, std::uint32_t sequence, Resolution resolution_px,
                      Serialization serialization, std::string& message);
void encodeImu(const ImuSample& sample, std::uint32_t sequence, Serialization serialization,
               std::string& message);

}  // namespace evical::ros
