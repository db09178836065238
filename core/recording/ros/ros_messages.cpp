#include "core/recording/ros/ros_messages.h"

#include "core/recording/byte_cursor.h"
#include "core/recording/ros/message_layout.h"

#include <algorithm>
#include <cstring>
#include <optional>

namespace evical::ros {
namespace {

constexpr std::size_t kEventBytes = 13;  // u16 x, u16 y, u32 s, u32 ns, u8 polarity
constexpr std::int64_t kSecond_ns = 1'000'000'000;

constexpr MessageType kEventArray = {
    StreamType::Events, "dvs_msgs/EventArray", "5e8beee5a6c107e504c2e78903c224b8",
    "Header header\nuint32 height\nuint32 width\nEvent[] events\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: dvs_msgs/Event\nuint16 x\nuint16 y\ntime ts\nbool polarity\n"};

constexpr MessageType kImu = {
    StreamType::Imu, "sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2",
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

std::int64_t takeTime(ByteCursor& cursor) {
  const std::int64_t seconds = cursor.number<std::uint32_t>();
  return seconds * kSecond_ns + cursor.number<std::uint32_t>();
}

std::int64_t takeHeader(ByteCursor& cursor) {
  cursor.number<std::uint32_t>();
  const std::int64_t stamp_ns = takeTime(cursor);
  cursor.sized();
  return stamp_ns;
}

// Also keeps the largest nanoseconds of a stamp: beyond a second, it is none.
Event eventAt(const char* bytes, std::uint32_t& largest_ns) {
  std::uint16_t x = 0, y = 0;
  std::uint32_t seconds = 0, nanoseconds = 0;
  std::memcpy(&x, bytes, 2);
  std::memcpy(&y, bytes + 2, 2);
  std::memcpy(&seconds, bytes + 4, 4);
  std::memcpy(&nanoseconds, bytes + 8, 4);
  largest_ns = std::max(largest_ns, nanoseconds);
  return {std::int64_t{seconds} * kSecond_ns + nanoseconds, x, y, bytes[12] != 0};
}

template <class Number>
void append(std::string& message, Number value) {
  message.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void appendTime(std::string& message, std::int64_t time_ns) {
  append(message, static_cast<std::uint32_t>(time_ns / kSecond_ns));
  append(message, static_cast<std::uint32_t>(time_ns % kSecond_ns));
}

void appendHeader(std::string& message, std::uint32_t sequence, std::int64_t time_ns) {
  append(message, sequence);
  appendTime(message, time_ns);
  append(message, std::uint32_t{0});  // no frame_id
}

std::string_view lastPart(std::string_view type) {
  return type.substr(type.rfind('/') + 1);
}

}  // namespace

const MessageType& eventArrayType() {
  return kEventArray;
}
const MessageType& imuType() {
  return kImu;
}

StreamType streamTypeOf(std::string_view type, std::string_view md5, std::string_view definition) {
  if (md5 == kEventArray.md5) return StreamType::Events;
  if (md5 == kImu.md5) return StreamType::Imu;
  if (type == "sensor_msgs/Image" || type == "sensor_msgs/CompressedImage") return StreamType::Frames;
  const std::optional<std::string> layout = messageLayout(definition);
  for (const MessageType* known : {&kEventArray, &kImu})
    if (layout && layout == messageLayout(known->definition)) return known->stream;
  // A definition that is there and has other fields overrules the name.
  if (layout && !layout->empty()) return StreamType::Other;
  // event_array_msgs/EventArray has this name too, but packed bytes inside.
  const bool packed = type.starts_with("event_array_msgs/") || type.starts_with("event_camera_msgs/");
  if (lastPart(type) == "EventArray" && !packed) return StreamType::Events;
  if (lastPart(type) == "Imu") return StreamType::Imu;
  return StreamType::Other;
}

bool decodeEventArray(std::string_view message, std::vector<Event>& events, Resolution& resolution_px) {
  ByteCursor cursor(message);
  takeHeader(cursor);
  const auto height = cursor.number<std::uint32_t>(), width = cursor.number<std::uint32_t>();
  const std::uint64_t count = cursor.number<std::uint32_t>();
  const std::string_view bytes = cursor.take(count * kEventBytes);
  events.resize(cursor.ok() && cursor.atEnd() ? static_cast<std::size_t>(count) : 0);
  if (!cursor.ok() || !cursor.atEnd()) return false;
  constexpr std::uint32_t kLargest_px = 65536;  // coordinates have 16 bits
  if (width > 0 && height > 0 && width <= kLargest_px && height <= kLargest_px) {
    resolution_px = {static_cast<int>(width), static_cast<int>(height)};
  }
  const char* source = bytes.data();
  std::uint32_t largest_ns = 0;
  for (Event& event : events) {
    event = eventAt(source, largest_ns);
    source += kEventBytes;
  }
  if (largest_ns < kSecond_ns) return true;
  events.clear();
  return false;
}

bool decodeImu(std::string_view message, std::vector<ImuSample>& samples) {
  samples.clear();
  ByteCursor cursor(message);
  ImuSample sample;
  sample.time_ns = takeHeader(cursor);
  const auto takeVector = [&cursor](Eigen::Vector3d& vector) {
    for (int i = 0; i < 3; ++i) vector[i] = cursor.number<double>();
  };
  cursor.take((4 + 9) * sizeof(double));  // orientation and its covariance
  takeVector(sample.angular_rate_rad_s);
  cursor.take(9 * sizeof(double));
  takeVector(sample.specific_force_m_s2);
  cursor.take(9 * sizeof(double));
  if (!cursor.ok() || !cursor.atEnd()) return false;
  samples.push_back(sample);
  return true;
}

void encodeEventArray(EventSpan events, std::uint32_t sequence, Resolution resolution_px,
                      std::string& message) {
  appendHeader(message, sequence, events.empty() ? 0 : events.front().time_ns);
  append(message, static_cast<std::uint32_t>(resolution_px.height_px));
  append(message, static_cast<std::uint32_t>(resolution_px.width_px));
  append(message, static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events) {
    append(message, event.x_px);
    append(message, event.y_px);
    appendTime(message, event.time_ns);
    message.push_back(event.brighter ? 1 : 0);
  }
}

void encodeImu(const ImuSample& sample, std::uint32_t sequence, std::string& message) {
  appendHeader(message, sequence, sample.time_ns);
  std::array<double, 4 + 9 + 3 + 9 + 3 + 9> numbers{};
  numbers[3] = 1.0;   // no rotation, and
  numbers[4] = -1.0;  // by the convention of sensor_msgs: there is no estimate of the orientation
  for (int i = 0; i < 3; ++i) {
    numbers[static_cast<std::size_t>(13 + i)] = sample.angular_rate_rad_s[i];
    numbers[static_cast<std::size_t>(25 + i)] = sample.specific_force_m_s2[i];
  }
  message.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
}

}  // namespace evical::ros
