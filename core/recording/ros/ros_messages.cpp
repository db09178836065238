#include "core/recording/ros/ros_messages.h"

#include "core/base/time.h"
#include "core/data/recording.h"
#include "core/recording/ros/message_cursor.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace evical::ros {
namespace {

constexpr std::size_t kEventBytes = 13;  // u16 x, u16 y, u32 s, u32 ns, u8 polarity

template <class Number>
Number numberAt(const char* bytes) {
  Number number{};
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

void takeResolution(MessageCursor& cursor, Resolution& resolution_px) {
  const auto height = cursor.number<std::uint32_t>(), width = cursor.number<std::uint32_t>();
  if (width > 0 && height > 0 && width <= kLargestSide_px && height <= kLargestSide_px)
    resolution_px = {static_cast<int>(width), static_cast<int>(height)};
}

// The three below return the largest nanoseconds of the stamps: above one second, a stamp is invalid.
std::uint32_t eventsOfRos1(std::string_view bytes, std::vector<Event>& events) {
  const char* at = bytes.data();
  std::uint32_t largest_ns = 0;
  for (Event& event : events) {
    const auto nanoseconds = numberAt<std::uint32_t>(at + 8);
    largest_ns = std::max(largest_ns, nanoseconds);
    event = {std::int64_t{numberAt<std::uint32_t>(at + 4)} * kSecond_ns + nanoseconds,
             numberAt<std::uint16_t>(at), numberAt<std::uint16_t>(at + 2), at[12] != 0};
    at += kEventBytes;
  }
  return largest_ns;
}

// The first event is at a multiple of 4.
std::uint32_t eventsOfCdr(std::string_view bytes, std::vector<Event>& events) {
  const char* const begin = bytes.data();
  std::size_t position = 0;
  std::uint32_t largest_ns = 0;
  for (Event& event : events) {
    const std::size_t x = position + position % 2, time = (x + 4 + 3) / 4 * 4;
    const auto nanoseconds = numberAt<std::uint32_t>(begin + time + 4);
    largest_ns = std::max(largest_ns, nanoseconds);
    event = {std::int64_t{numberAt<std::int32_t>(begin + time)} * kSecond_ns + nanoseconds,
             numberAt<std::uint16_t>(begin + x), numberAt<std::uint16_t>(begin + x + 2),
             begin[time + 8] != 0};
    position = time + 9;
  }
  return largest_ns;
}

std::uint32_t eventsOfBigEndianCdr(MessageCursor& cursor, std::vector<Event>& events) {
  std::uint32_t largest_ns = 0;
  for (Event& event : events) {
    event.x_px = cursor.number<std::uint16_t>();
    event.y_px = cursor.number<std::uint16_t>();
    const std::int64_t seconds = cursor.number<std::int32_t>();
    const auto nanoseconds = cursor.number<std::uint32_t>();
    largest_ns = std::max(largest_ns, nanoseconds);
    event.time_ns = seconds * kSecond_ns + nanoseconds;
    event.brighter = cursor.number<std::uint8_t>() != 0;
  }
  return largest_ns;
}

// Bytes of `count` events. In CDR all but the first have 16 with their padding.
std::uint64_t sizeOfEvents(std::uint64_t count, Serialization serialization) {
  if (serialization == Serialization::Ros1) return count * kEventBytes;
  return count == 0 ? 0 : 16 * count - 3;
}

}  // namespace

bool decodeEventArray(std::string_view message, Serialization serialization, std::vector<Event>& events,
                      Resolution& resolution_px) {
  events.clear();
  MessageCursor cursor(message, serialization);
  cursor.header();
  takeResolution(cursor, resolution_px);
  const std::uint64_t count = cursor.number<std::uint32_t>();
  const std::uint64_t size = sizeOfEvents(count, serialization);
  if (!cursor.ok() || size > cursor.remaining()) return false;
  events.resize(static_cast<std::size_t>(count));
  std::uint32_t largest_ns = 0;
  if (cursor.bigEndian()) {
    largest_ns = eventsOfBigEndianCdr(cursor, events);
  } else if (const std::string_view bytes = cursor.take(size); cursor.isRos1()) {
    largest_ns = eventsOfRos1(bytes, events);
  } else {
    largest_ns = eventsOfCdr(bytes, events);
  }
  if (cursor.wellEnded() && largest_ns < kSecond_ns) return true;
  events.clear();
  return false;
}

bool decodeOldEventArray(std::string_view message, std::vector<Event>& events) {
  events.clear();
  MessageCursor cursor(message, Serialization::Ros1);
  const std::uint64_t count = cursor.number<std::uint32_t>();
  if (!cursor.ok() || count * kEventBytes > cursor.remaining()) return false;
  events.resize(static_cast<std::size_t>(count));
  constexpr std::uint64_t kLatest_us = static_cast<std::uint64_t>(kLatestTime_ns / kMicrosecond_ns);
  bool good = true;
  for (Event& event : events) {
    event.x_px = cursor.number<std::uint16_t>();
    event.y_px = cursor.number<std::uint16_t>();
    const auto time_us = cursor.number<std::uint64_t>();
    good = good && time_us <= kLatest_us;
    event.time_ns = good ? static_cast<std::int64_t>(time_us) * kMicrosecond_ns : 0;
    event.brighter = cursor.number<std::uint8_t>() != 0;
  }
  if (good && cursor.wellEnded()) return true;
  events.clear();
  return false;
}

bool decodeImu(std::string_view message, Serialization serialization, std::vector<RawImuSample>& samples) {
  samples.clear();
  MessageCursor cursor(message, serialization);
  RawImuSample sample;
  sample.time_ns = cursor.header();
  const auto skip = [&cursor](int numbers) {
    for (int i = 0; i < numbers; ++i) cursor.number<double>();
  };
  const auto takeVector = [&cursor](Eigen::Vector3d& vector) {
    for (int i = 0; i < 3; ++i) vector[i] = cursor.number<double>();
  };
  skip(4 + 9);  // orientation and its covariance
  // By the convention of sensor_msgs, a covariance that begins with -1 marks a missing measurement.
  const auto isMeasured = [&] {
    const bool measured = cursor.number<double>() != -1.0;
    skip(8);
    return measured;
  };
  takeVector(sample.angular_rate);
  const bool has_rate = isMeasured();
  takeVector(sample.specific_force);
  const bool has_force = isMeasured();
  if (!cursor.wellEnded()) return false;
  if (has_rate != has_force)
    sample.measured_by = has_rate ? MeasuredBy::Gyroscope : MeasuredBy::Accelerometer;
  samples.push_back(sample);
  return true;
}

bool parseEventPacket(std::string_view message, Serialization serialization, EventPacket& packet) {
  packet = {};
  MessageCursor cursor(message, serialization);
  packet.stamp_ns = cursor.header();
  takeResolution(cursor, packet.resolution_px);
  packet.sequence = cursor.number<std::uint64_t>();
  packet.time_base_ns = static_cast<std::int64_t>(cursor.number<std::uint64_t>());
  packet.encoding = cursor.text();
  packet.big_endian = cursor.number<std::uint8_t>() != 0;
  packet.events = cursor.sequence();
  constexpr std::int64_t kLatest_ns = std::int64_t{1} << 61;  // far beyond the range of ROS times
  return cursor.wellEnded() && packet.time_base_ns >= 0 && packet.time_base_ns <= kLatest_ns;
}

void encodeEventArray(EventSpan events, std::uint32_t sequence, Resolution resolution_px,
                      Serialization serialization, std::string& message) {
  message.reserve(message.size() + 64 + 16 * events.size());
  MessageBytes bytes(message, serialization);
  bytes.appendHeader(sequence, events.empty() ? 0 : events.front().time_ns);
  bytes.append(static_cast<std::uint32_t>(resolution_px.height_px));
  bytes.append(static_cast<std::uint32_t>(resolution_px.width_px));
  bytes.append(static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events) {
    bytes.append(event.x_px);
    bytes.append(event.y_px);
    bytes.appendTime(event.time_ns);
    bytes.append(static_cast<std::uint8_t>(event.brighter ? 1 : 0));
  }
}

void encodeImu(const ImuSample& sample, std::uint32_t sequence, Serialization serialization,
               std::string& message) {
  MessageBytes bytes(message, serialization);
  bytes.appendHeader(sequence, sample.time_ns);
  std::array<double, 4 + 9 + 3 + 9 + 3 + 9> numbers{};
  numbers[3] = 1.0;   // no rotation,
  numbers[4] = -1.0;  // marked as missing, by the convention of sensor_msgs
  for (int i = 0; i < 3; ++i) {
    numbers[static_cast<std::size_t>(13 + i)] = sample.angular_rate_rad_s[i];
    numbers[static_cast<std::size_t>(25 + i)] = sample.specific_force_m_s2[i];
  }
  if (sample.measured_by == MeasuredBy::Accelerometer) numbers[16] = -1.0;
  if (sample.measured_by == MeasuredBy::Gyroscope) numbers[28] = -1.0;
  for (const double number : numbers) bytes.append(number);
}

}  // namespace evical::ros
