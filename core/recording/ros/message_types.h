// Types of ROS messages that can be read, and their recognition.
#pragma once

#include "core/data/recording.h"
#include "core/recording/ros/message_cursor.h"

#include <optional>
#include <string>
#include <string_view>

namespace evical::ros {

enum class Content { Other, EventArray, OldEventArray, EventPacket, Imu, Image, PackedImage };

StreamType streamTypeOf(Content content);

struct MessageType {
  Content content;
  const char* name;        // name that Evical writes
  const char* md5;         // of the definition; empty for ROS 2
  const char* definition;  // for other programs that read the file
};
const MessageType& eventArrayType(Serialization serialization);
const MessageType& imuType(Serialization serialization);
const MessageType& imageType(Serialization serialization);
const MessageType& packedImageType(Serialization serialization);

// By md5 first, then by the fields of the definition, and without one by the name of a known package, or the
// last part of any name: packages are renamed and copied, and forks have other fields.
Content contentOf(std::string_view type, std::string_view md5, std::string_view definition);

// Why messages that may be of a sensor are not read; empty for others.
std::string whyUnread(std::string_view topic, std::string_view type, std::string_view definition);

// Serialised layout of a ROS message definition, to recognise copies of a type under another name.

// The name of a type without its package: "Imu" of "sensor_msgs/Imu".
inline std::string_view lastPart(std::string_view type) {
  return type.substr(type.rfind('/') + 1);
}

// Fields in order with nested types expanded and without their names: "(uint32 seq,...) header,uint32
// height,...". nullopt if the definition names a type that it does not define; empty for an empty one.
std::optional<std::string> messageLayout(std::string_view definition);

}  // namespace evical::ros
