// What a ROS message definition serialises to, so that copies of a type under another name are recognised.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace evical::ros {

// The fields in order with nested types expanded and their names gone: "(uint32 seq,...) header,uint32
// height,...". Nothing if the definition names a type that it does not define; empty for an empty one.
std::optional<std::string> messageLayout(std::string_view definition);

}  // namespace evical::ros
