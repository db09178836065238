// Which message type is which (ros_message.h).
#include "core/recording/ros_message.h"

#include <array>
#include <map>
#include <vector>

namespace evical {
namespace {

constexpr std::string_view kEventArrayMd5 = "5e8beee5a6c107e504c2e78903c224b8";
constexpr std::string_view kImuMd5 = "6a62c6daae103f4ff57a132d6f95cec2";
constexpr std::string_view kImageMd5 = "060021388200f6f0f447d0fcd9c64743";
constexpr std::string_view kEventPacketMd5 = "8a6101b351a64529ac77bd8b71074e52";

constexpr const char* kEventArrayDefinition = R"(Header header
uint32 height
uint32 width
Event[] events
================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
================================================================================
MSG: dvs_msgs/Event
uint16 x
uint16 y
time ts
bool polarity
)";

constexpr const char* kImuDefinition = R"(Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
)";

constexpr int kDeepestNesting = 8;            // of types; a definition that names itself stops here
constexpr std::size_t kLongestLayout = 8192;  // characters; a definition may nest so as to explode

std::string_view lastPart(std::string_view type) {
  return type.substr(type.rfind('/') + 1);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

struct FieldLine {
  std::string_view type, array, name;  // array: "", "[]" or "[9]"
};
using TypeTable = std::map<std::string_view, std::vector<FieldLine>>;  // by the last part of the type's name

// "float64[9] name # comment" is a field; "uint8 LIMIT=3" a constant, which isn't serialised.
bool parseFieldLine(std::string_view line, FieldLine& field) {
  line = trimmed(line.substr(0, line.find('#')));
  const std::size_t blank = line.find_first_of(" \t");
  if (blank == std::string_view::npos || line.find('=') != std::string_view::npos) return false;
  field.name = trimmed(line.substr(blank));
  const std::string_view type = line.substr(0, blank);
  const std::size_t bracket = type.find('[');
  field.array = bracket == std::string_view::npos ? std::string_view() : type.substr(bracket);
  field.type = lastPart(type.substr(0, bracket));
  return true;
}

// The fields of the main type come under the name "".
TypeTable parseDefinition(std::string_view definition) {
  TypeTable types;
  std::string_view current;
  types[current];
  while (!definition.empty()) {
    const std::size_t end = definition.find('\n');
    const std::string_view line = trimmed(definition.substr(0, end));
    definition = end == std::string_view::npos ? std::string_view() : definition.substr(end + 1);
    FieldLine field;
    if (line.starts_with("MSG:")) {
      current = lastPart(trimmed(line.substr(4)));
      types[current];
    } else if (parseFieldLine(line, field)) {
      types[current].push_back(field);
    }
  }
  return types;
}

std::string_view primitive(std::string_view type) {
  if (type == "bool" || type == "byte" || type == "char") return "uint8";  // one byte, all of them
  constexpr std::array known = {"uint8", "int8",    "uint16",  "int16",  "uint32", "int32",   "uint64",
                                "int64", "float32", "float64", "string", "time",   "duration"};
  for (const std::string_view name : known)
    if (type == name) return name;
  return {};
}

bool appendLayout(const TypeTable& types, std::string_view type, int depth, std::string& layout) {
  const auto entry = types.find(type);
  if (entry == types.end() || depth > kDeepestNesting) return false;
  for (const FieldLine& field : entry->second) {
    if (layout.size() > kLongestLayout) return false;
    if (const std::string_view simple = primitive(field.type); !simple.empty()) {
      layout.append(simple).append(field.array).append(" ").append(field.name).append(",");
      continue;
    }
    layout.append("(");
    if (!appendLayout(types, field.type, depth + 1, layout)) return false;
    layout.append(")").append(field.array).append(" ").append(field.name).append(",");
  }
  return true;
}

RosMessage byMd5(std::string_view md5) {
  if (md5 == kEventArrayMd5) return RosMessage::EventArray;
  if (md5 == kImuMd5) return RosMessage::Imu;
  if (md5 == kImageMd5) return RosMessage::Image;
  if (md5 == kEventPacketMd5) return RosMessage::EventPacket;
  return RosMessage::Other;
}

RosMessage byName(std::string_view name) {
  if (name == "EventArray") return RosMessage::EventArray;
  if (name == "Imu") return RosMessage::Imu;
  if (name == "Image") return RosMessage::Image;
  if (name == "EventPacket") return RosMessage::EventPacket;
  return RosMessage::Other;
}

RosMessage byLayout(const std::optional<std::string>& layout) {
  if (!layout) return RosMessage::Other;
  if (layout == messageLayout(kEventArrayDefinition)) return RosMessage::EventArray;
  if (layout == messageLayout(kImuDefinition)) return RosMessage::Imu;
  return RosMessage::Other;
}

}  // namespace

std::optional<std::string> messageLayout(std::string_view definition) {
  std::string layout;
  if (!appendLayout(parseDefinition(definition), "", 0, layout)) return std::nullopt;
  return layout;
}

RosMessage identifyMessage(std::string_view type, std::string_view md5, std::string_view definition) {
  if (const RosMessage known = byMd5(md5); known != RosMessage::Other) return known;
  const std::optional<std::string> layout = messageLayout(definition);
  if (const RosMessage same = byLayout(layout); same != RosMessage::Other) return same;
  // The definition, where there is one, names other fields than the type that we know under this name.
  if (layout && !layout->empty()) return RosMessage::Other;
  return byName(lastPart(type));
}

RosMessageType eventArrayType() {
  return {"dvs_msgs/EventArray", kEventArrayMd5.data(), kEventArrayDefinition};
}

RosMessageType imuType() {
  return {"sensor_msgs/Imu", kImuMd5.data(), kImuDefinition};
}

}  // namespace evical
