#include "core/recording/aedat/aedat3_packets.h"

#include "core/base/time.h"
#include "core/data/recording.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical::aedat3 {
namespace {

constexpr std::uint64_t kLargestPacket_bytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kFrameHeader_bytes = 36;
constexpr std::int32_t kSmallestEvent_bytes = 8;
constexpr std::int32_t kTimeOffset_bytes = 4;  // of the types with a known size
constexpr std::int16_t kLastType = 12;
constexpr std::int16_t kMaxSources = 256;

Type typeOf(std::int16_t number) {
  return number <= static_cast<std::int16_t>(Type::Imu9) ? static_cast<Type>(number) : Type::Other;
}

// Size of one event; 0: any.
std::uint64_t elementSize(Type type) {
  switch (type) {
    case Type::Special:
    case Type::Polarity:
      return 8;
    case Type::Imu6:
      return 36;
    case Type::Imu9:
      return 48;
    case Type::Frame:
    case Type::Other:
      break;
  }
  return 0;
}

bool takeTime(const PacketHeader& header, std::int32_t time_us, std::int64_t& time_ns) {
  constexpr std::int64_t kLatest_us = kLatestTime_ns / kMicrosecond_ns;
  const std::int64_t full_us = (header.overflow << 31) + time_us;
  if (time_us < 0 || full_us > kLatest_us) return false;
  time_ns = full_us * kMicrosecond_ns;
  return true;
}

std::string_view eventAt(const PacketHeader& header, std::string_view bytes, std::uint64_t index) {
  return bytes.substr(static_cast<std::size_t>(index * header.event_bytes),
                      static_cast<std::size_t>(header.event_bytes));
}

struct FrameFields {
  unsigned channels = 0;
  std::int32_t begin_us = 0, end_us = 0;  // of the exposure
  std::int32_t width = 0, height = 0, left = 0, top = 0;
};

FrameFields takeFrameFields(ByteCursor& cursor) {
  FrameFields fields;
  fields.channels = cursor.number<std::uint32_t>() >> 1 & 7;
  cursor.take(8);  // begin and end of the reading
  fields.begin_us = cursor.number<std::int32_t>();
  fields.end_us = cursor.number<std::int32_t>();
  for (std::int32_t* number : {&fields.width, &fields.height, &fields.left, &fields.top})
    *number = cursor.number<std::int32_t>();
  return fields;
}

// Values have 16 bits; for colours only the upper 8 are returned.
void takePixels(std::string_view values, unsigned channels, Frame& frame) {
  const std::size_t width = static_cast<std::size_t>(frame.size_px.width_px);
  if (channels == 1) {
    frame.format = FrameFormat::Gray16;
    frame.row_bytes = 2 * width;
    frame.bytes.assign(values.begin(), values.end());
    return;
  }
  frame.format = channels == 3 ? FrameFormat::Rgb8 : FrameFormat::Rgba8;
  frame.row_bytes = channels * width;
  frame.bytes.resize(values.size() / 2);
  for (std::size_t i = 0; i < frame.bytes.size(); ++i)
    frame.bytes[i] = static_cast<std::uint8_t>(values[2 * i + 1]);
}

bool decodeFrame(const PacketHeader& header, std::string_view bytes, std::vector<Frame>& frames,
                 std::string& unusable) {
  ByteCursor cursor(bytes);
  const FrameFields fields = takeFrameFields(cursor);
  Frame frame;
  std::int64_t end_ns = 0;
  const auto isSide = [](std::int32_t side_px) { return side_px >= 1 && side_px <= kLargestSide_px; };
  if (!cursor.ok() || !isSide(fields.width) || !isSide(fields.height) ||
      !takeTime(header, fields.begin_us, frame.time_ns) || !takeTime(header, fields.end_us, end_ns))
    return false;
  if (fields.channels != 1 && fields.channels != 3 && fields.channels != 4) {
    unusable = fmt::format("have {} channels of colour", fields.channels);
    return true;
  }
  if (fields.left != 0 || fields.top != 0) {
    unusable =
        fmt::format("show only a part of the sensor, from column {} and row {}", fields.left, fields.top);
    return true;
  }
  const std::string_view values =
      cursor.take(std::uint64_t{2} * fields.channels * static_cast<std::uint64_t>(fields.width) *
                  static_cast<std::uint64_t>(fields.height));
  if (!cursor.ok()) return false;
  frame.size_px = {fields.width, fields.height};
  if (end_ns > frame.time_ns) {
    frame.exposure_s = secondsSince(frame.time_ns, end_ns);
    frame.time_ns += (end_ns - frame.time_ns) / 2;
  }
  takePixels(values, fields.channels, frame);
  frames.push_back(std::move(frame));
  return true;
}

}  // namespace

std::optional<PacketHeader> decodeHeader(std::string_view bytes) {
  ByteCursor cursor(bytes);
  const auto type = cursor.number<std::int16_t>(), source = cursor.number<std::int16_t>();
  const auto size = cursor.number<std::int32_t>(), time_offset = cursor.number<std::int32_t>();
  const auto overflow = cursor.number<std::int32_t>(), capacity = cursor.number<std::int32_t>();
  const auto events = cursor.number<std::int32_t>(), valid = cursor.number<std::int32_t>();
  const bool possible = cursor.ok() && type >= 0 && type <= kLastType && source >= 0 &&
                        source < kMaxSources && size >= kSmallestEvent_bytes && time_offset >= 0 &&
                        time_offset <= size - 4 && overflow >= 0 && capacity == events && valid >= 0 &&
                        valid <= events;
  if (!possible) return std::nullopt;
  PacketHeader header;
  header.type = typeOf(type);
  header.source = source;
  header.event_bytes = static_cast<std::uint64_t>(size);
  header.overflow = overflow;
  header.events = static_cast<std::uint64_t>(events);
  header.valid = static_cast<std::uint64_t>(valid);
  const std::uint64_t known = elementSize(header.type);
  const bool fits = (known == 0 || (known == header.event_bytes && time_offset == kTimeOffset_bytes)) &&
                    (header.type != Type::Frame || header.event_bytes >= kFrameHeader_bytes);
  if (!fits || header.dataBytes() > kLargestPacket_bytes) return std::nullopt;
  return header;
}

bool decodePolarity(const PacketHeader& header, std::string_view bytes, std::vector<Event>& events) {
  bool good = true;
  events.reserve(events.size() + static_cast<std::size_t>(header.events));
  for (std::uint64_t i = 0; i < header.events; ++i) {
    ByteCursor cursor(eventAt(header, bytes, i));
    const auto data = cursor.number<std::uint32_t>();
    if ((data & 1) == 0) continue;
    Event event{};
    if (!takeTime(header, cursor.number<std::int32_t>(), event.time_ns)) {
      good = false;
      continue;
    }
    event.brighter = (data >> 1 & 1) != 0;
    event.y_px = static_cast<std::uint16_t>(data >> 2 & 0x7FFF);
    event.x_px = static_cast<std::uint16_t>(data >> 17);
    events.push_back(event);
  }
  return good;
}

bool decodeImu(const PacketHeader& header, std::string_view bytes, std::vector<RawImuSample>& samples) {
  bool good = true;
  for (std::uint64_t i = 0; i < header.events; ++i) {
    ByteCursor cursor(eventAt(header, bytes, i));
    if ((cursor.number<std::uint32_t>() & 1) == 0) continue;
    RawImuSample sample;
    if (!takeTime(header, cursor.number<std::int32_t>(), sample.time_ns)) {
      good = false;
      continue;
    }
    for (double& value : sample.specific_force) value = static_cast<double>(cursor.number<float>());
    for (double& value : sample.angular_rate) value = static_cast<double>(cursor.number<float>());
    samples.push_back(sample);
  }
  return good;
}

bool decodeFrames(const PacketHeader& header, std::string_view bytes, std::vector<Frame>& frames,
                  std::string& unusable) {
  bool good = true;
  for (std::uint64_t i = 0; i < header.events; ++i) {
    const std::string_view event = eventAt(header, bytes, i);
    if ((ByteCursor(event).number<std::uint32_t>() & 1) == 0) continue;
    good = decodeFrame(header, event, frames, unusable) && good;
  }
  return good;
}

SpecialCounts countSpecial(const PacketHeader& header, std::string_view bytes) {
  SpecialCounts counts;
  for (std::uint64_t i = 0; i < header.events; ++i) {
    const auto data = ByteCursor(eventAt(header, bytes, i)).number<std::uint32_t>();
    const unsigned kind = data >> 1 & 0x7F;
    if ((data & 1) == 0) continue;
    if (kind == 1) ++counts.resets;
    if ((kind >= 2 && kind <= 4) || (kind >= 6 && kind <= 13)) ++counts.triggers;
  }
  return counts;
}

}  // namespace evical::aedat3
