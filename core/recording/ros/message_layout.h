// Serialised layout of a ROS message definition, to recognise copies of a type under another name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace evical::ros {

// The name of a type without its package: "Imu" of "sensor_msgs/Imu".
inline std::string_view lastPart(std::string_view type) {
  return type.substr(type.rfind('/') + 1);
}

// Fields in order with nested types expanded and without their names: "(uint32 seq,...) header,uint32
// height,...". nullopt if the definition names a type that it does not define; empty for an empty one.
std::optional<std::string> messageLayout(std::string_view definition);

}  // namespace evical::ros
