// ROS 1 messages that carry events and IMU samples: which type is which, and their bytes. All messages here
// begin with std_msgs/Header: u32 seq, time stamp, string frame_id.
#pragma once

#include "core/data/event.h"
#include "core/data/imu_sample.h"
#include "core/geometry/camera_model.h"
#include "core/recording/byte_reader.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

enum class RosMessage {
  EventArray,   // dvs_msgs, prophesee_event_msgs, and copies of them under other names
  Imu,          // sensor_msgs
  Image,        // sensor_msgs
  EventPacket,  // event_camera_msgs: events, in encodings that are not read yet
  Other,
};

// By md5; else by the last part of the type's name, as far as the definition does not contradict; else by a
// definition with the same fields in the same order. Packages get renamed and copied, layouts stay.
RosMessage identifyMessage(std::string_view type, std::string_view md5, std::string_view definition);

// What a definition serialises to, with nested types expanded and their names gone: "u32 height,u32
// width,...". Nothing if it names a type that it does not define.
std::optional<std::string> messageLayout(std::string_view definition);

// type, md5 and definition for a bag's connection record.
struct RosMessageType {
  const char *type, *md5, *definition;
};
RosMessageType eventArrayType();
RosMessageType imuType();

inline constexpr std::size_t kRosEventSize = 13;  // u16 x, u16 y, u32 s, u32 ns, u8 polarity, without padding

struct EventArrayView {
  std::int64_t stamp_ns = 0;  // of the message
  Resolution resolution_px;   // 0 x 0 from some converters
  Bytes events;               // a multiple of kRosEventSize
};

// Nothing where a length in the message does not fit the message.
std::optional<EventArrayView> parseEventArray(Bytes message);

// Decodes `count` events from `bytes` into `events`; false if a stamp is none (nanoseconds beyond a second).
bool decodeEvents(const std::uint8_t* bytes, std::size_t count, Event* events);

// Nothing where the message is too short or its stamp is none.
std::optional<ImuSample> parseImu(Bytes message);

// Of an image or event array.
std::optional<Resolution> parseResolution(Bytes message);

void appendEventArray(std::vector<std::uint8_t>& bytes, std::uint32_t sequence, std::string_view frame,
                      Resolution resolution, EventSpan events);
void appendImu(std::vector<std::uint8_t>& bytes, std::uint32_t sequence, std::string_view frame,
               const ImuSample& sample);

}  // namespace evical
