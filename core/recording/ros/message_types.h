// Types of ROS messages that can be read, and their recognition.
#pragma once

#include "core/data/recording.h"
#include "core/recording/ros/message_cursor.h"

#include <string_view>

namespace evical::ros {

enum class Content { Other, EventArray, EventPacket, Imu, Image, PackedImage };

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

// By md5 first, then by the names of known packages, then by the fields of the definition, and without one by
// the last part of the name: packages are renamed and copied.
Content contentOf(std::string_view type, std::string_view md5, std::string_view definition);

}  // namespace evical::ros
