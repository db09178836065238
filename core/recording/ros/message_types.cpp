#include "core/recording/ros/message_types.h"

#include "core/base/plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace evical::ros {
namespace {

constexpr MessageType kEventArray1 = {
    Content::EventArray, "dvs_msgs/EventArray", "5e8beee5a6c107e504c2e78903c224b8",
    "Header header\nuint32 height\nuint32 width\nEvent[] events\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: dvs_msgs/Event\nuint16 x\nuint16 y\ntime ts\nbool polarity\n"};

constexpr MessageType kEventArray2 = {
    Content::EventArray, "dvs_msgs/msg/EventArray", "",
    "std_msgs/Header header\nuint32 height\nuint32 width\ndvs_msgs/Event[] events\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    "================================================================================\n"
    "MSG: dvs_msgs/Event\nuint16 x\nuint16 y\nbuiltin_interfaces/Time ts\nbool polarity\n"};

// Before 2015: without a header and a size; times are us.
constexpr MessageType kOldEventArray1 = {
    Content::OldEventArray, "dvs_msgs/EventArray", "d2e726b2040dbc135644f4709c150a10",
    "Event[] events\n"
    "================================================================================\n"
    "MSG: dvs_msgs/Event\nuint16 x\nuint16 y\nuint64 time\nbool polarity\n"};

constexpr MessageType kEventPacket1 = {
    Content::EventPacket, "event_camera_msgs/EventPacket", "8a6101b351a64529ac77bd8b71074e52",
    "std_msgs/Header header\nuint32 height\nuint32 width\nuint64 seq\nuint64 time_base\nstring encoding\n"
    "bool is_bigendian\nuint8[] events\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"};

constexpr MessageType kEventPacket2 = {
    Content::EventPacket, "event_camera_msgs/msg/EventPacket", "",
    "std_msgs/Header header\nuint32 height\nuint32 width\nuint64 seq\nuint64 time_base\nstring encoding\n"
    "bool is_bigendian\nuint8[] events\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"};

constexpr MessageType kImu1 = {
    Content::Imu, "sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2",
    "Header header\ngeometry_msgs/Quaternion orientation\n"
    "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
    "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
    "float64[9] linear_acceleration_covariance\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"};

constexpr MessageType kImu2 = {
    Content::Imu, "sensor_msgs/msg/Imu", "",
    "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
    "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
    "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
    "float64[9] linear_acceleration_covariance\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"};

constexpr MessageType kImage1 = {
    Content::Image, "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743",
    "Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] "
    "data\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"};

constexpr MessageType kImage2 = {
    Content::Image, "sensor_msgs/msg/Image", "",
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 "
    "step\nuint8[] data\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"};

constexpr MessageType kPackedImage1 = {
    Content::PackedImage, "sensor_msgs/CompressedImage", "8f7a12909da2c9d3332d540a0977563f",
    "Header header\nstring format\nuint8[] data\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"};

constexpr MessageType kPackedImage2 = {
    Content::PackedImage, "sensor_msgs/msg/CompressedImage", "",
    "std_msgs/Header header\nstring format\nuint8[] data\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"};

constexpr std::array kTypes = {&kEventArray1,  &kEventArray2,  &kOldEventArray1, &kEventPacket1,
                               &kEventPacket2, &kImu1,         &kImu2,           &kImage1,
                               &kImage2,       &kPackedImage1, &kPackedImage2};

struct KnownName {
  std::string_view type;  // as ROS 1 writes it
  Content content;
};
constexpr std::array kKnownNames = {
    KnownName{"dvs_msgs/EventArray", Content::EventArray},
    KnownName{"prophesee_event_msgs/EventArray", Content::EventArray},
    KnownName{"event_camera_msgs/EventPacket", Content::EventPacket},
    KnownName{"event_array_msgs/EventArray", Content::EventPacket},  // its old name
    KnownName{"sensor_msgs/Imu", Content::Imu},
    KnownName{"sensor_msgs/Image", Content::Image},
    KnownName{"sensor_msgs/CompressedImage", Content::PackedImage}};

Content contentByLastPart(std::string_view type) {
  const std::string_view last = lastPart(type);
  if (last == "EventArray") return Content::EventArray;
  if (last == "EventPacket") return Content::EventPacket;
  return last == "Imu" ? Content::Imu : Content::Other;
}

std::string inRos1(std::string_view type) {
  std::string plain(type);
  if (const std::size_t infix = plain.find("/msg/"); infix != std::string::npos) plain.erase(infix, 4);
  return plain;
}

Content contentByName(std::string_view type) {
  const std::string plain = inRos1(type);
  for (const KnownName& known : kKnownNames)
    if (plain == known.type) return known.content;
  return Content::Other;
}

std::string lowered(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

bool hasOneOf(const std::string& text, std::initializer_list<const char*> words) {
  return std::ranges::any_of(words, [&](const char* word) { return text.find(word) != std::string::npos; });
}

// The fields of a message itself, without those of its parts.
std::string fieldsOf(std::string_view definition) {
  std::string fields;
  for (std::string_view rest = definition.substr(0, definition.find("\n=")); !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = trimmed(rest.substr(0, std::min(rest.find('#'), end)));
    if (!line.empty()) fields += (fields.empty() ? "" : ", ") + std::string(line);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  constexpr std::size_t kMax = 200;
  return fields.size() > kMax ? fields.substr(0, kMax) + " ..." : fields;
}

}  // namespace

StreamType streamTypeOf(Content content) {
  switch (content) {
    case Content::EventArray:
    case Content::OldEventArray:
    case Content::EventPacket:
      return StreamType::Events;
    case Content::Imu:
      return StreamType::Imu;
    case Content::Image:
    case Content::PackedImage:
      return StreamType::Frames;
    case Content::Other:
      break;
  }
  return StreamType::Other;
}

const MessageType& eventArrayType(Serialization serialization) {
  return serialization == Serialization::Cdr ? kEventArray2 : kEventArray1;
}
const MessageType& imuType(Serialization serialization) {
  return serialization == Serialization::Cdr ? kImu2 : kImu1;
}

const MessageType& imageType(Serialization serialization) {
  return serialization == Serialization::Cdr ? kImage2 : kImage1;
}
const MessageType& packedImageType(Serialization serialization) {
  return serialization == Serialization::Cdr ? kPackedImage2 : kPackedImage1;
}

Content contentOf(std::string_view type, std::string_view md5, std::string_view definition) {
  for (const MessageType* known : kTypes)
    if (!md5.empty() && md5 == known->md5) return known->content;
  const std::optional<std::string> layout = messageLayout(definition);
  for (const MessageType* known : kTypes)
    if (layout && layout == messageLayout(known->definition)) return known->content;
  // The fields of an existing definition take precedence over the name.
  if (layout && !layout->empty()) return Content::Other;
  const Content known = contentByName(type);
  return known != Content::Other ? known : contentByLastPart(type);
}

std::string whyUnread(std::string_view topic, std::string_view type, std::string_view definition) {
  const std::string fields = fieldsOf(definition);
  if (contentByName(type) != Content::Other)
    return fmt::format("The messages of type {} have other fields ({}) than those that are read.", type,
                       fields);
  const std::string words = lowered(topic) + " " + lowered(type);
  const bool measures =
      hasOneOf(lowered(type), {"vector3", "accel", "twist", "quaternion", "float", "array"});
  const bool is_imu = hasOneOf(lowered(lastPart(type)), {"imu", "inertial", "sensorcombined", "gyro"}) ||
                      (measures && hasOneOf(words, {"imu", "gyro", "accel", "/acc"}));
  if (is_imu)
    return fmt::format(
        "{} has messages of type {}, probably of an IMU, which are not read: convert them to "
        "sensor_msgs/Imu, or to a CSV table.",
        topic, type);
  if (!hasOneOf(words, {"dvs", "event", "davis", "prophesee"}) ||
      hasOneOf(words, {"info", "param", "diagnos", "rosout", "clock"}))
    return {};
  if (!hasOneOf(lowered(lastPart(type)), {"event", "packet", "array"})) return {};
  return fmt::format(
      "{} has messages of type {}, probably with events, which are not read: convert them to "
      "dvs_msgs/EventArray.",
      topic, type);
}

namespace {

constexpr int kDeepestNesting = 8;            // of types; ends recursive definitions
constexpr std::size_t kLongestLayout = 8192;  // characters; limits nested definitions

struct FieldLine {
  std::string_view type, array, name;  // array: "", "[]" or "[9]"
};
// By the last part of a type's name; "" for the message itself.
using TypeTable = std::map<std::string_view, std::vector<FieldLine>>;

// "float64[9] name # comment" is a field; "uint8 LIMIT=3" a constant, which is not serialised.
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

// Empty except for built-in types.
std::string_view builtIn(std::string_view type) {
  if (type == "bool" || type == "byte" || type == "char") return "uint8";  // one byte, all of them
  constexpr std::array<std::string_view, 13> kKnown = {"uint8",  "int8",   "uint16",  "int16",   "uint32",
                                                       "int32",  "uint64", "int64",   "float32", "float64",
                                                       "string", "time",   "duration"};
  for (const std::string_view name : kKnown)
    if (type == name) return name;
  return {};
}

bool appendLayout(const TypeTable& types, std::string_view type, int depth, std::string& layout) {
  const auto entry = types.find(type);
  if (entry == types.end() || depth > kDeepestNesting) return false;
  for (const FieldLine& field : entry->second) {
    if (layout.size() > kLongestLayout) return false;
    if (const std::string_view simple = builtIn(field.type); !simple.empty()) {
      layout.append(simple);
    } else {
      layout += '(';
      if (!appendLayout(types, field.type, depth + 1, layout)) return false;
      layout += ')';
    }
    layout.append(field.array).append(" ").append(field.name).append(",");
  }
  return true;
}

}  // namespace

std::optional<std::string> messageLayout(std::string_view definition) {
  std::string layout;
  if (!appendLayout(parseDefinition(definition), "", 0, layout)) return std::nullopt;
  return layout;
}

}  // namespace evical::ros
