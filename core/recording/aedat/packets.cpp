#include "core/recording/aedat/packets.h"

#include "core/base/time.h"
#include "core/recording/aedat/flat_buffer.h"

#include <algorithm>
#include <array>
#include <limits>

namespace evical::aedat {
namespace {

constexpr std::size_t kEvent_bytes = 16;  // i64 t, i16 x, i16 y, u8 on, 3 bytes of padding
constexpr std::int64_t kLatest_us = kLatestTime_ns / kMicrosecond_ns;

bool isMicrosecond(std::int64_t time_us) {
  return time_us >= -kLatest_us && time_us <= kLatest_us;
}

struct Reading {
  FlatBuffer buffer;
  FlatTable root;
  bool good = false;
};

Reading open(std::string_view bytes, std::string_view type) {
  Reading reading{FlatBuffer(bytes), {}};
  if (!reading.buffer.ok() || reading.buffer.identifier() != type) return reading;
  reading.root = reading.buffer.root();
  reading.good = reading.buffer.ok();
  return reading;
}

}  // namespace

std::optional<FileHeader> decodeHeader(std::string_view bytes) {
  auto [buffer, root, good] = open(bytes, "IOHE");
  if (!good) return std::nullopt;
  FileHeader header;
  header.compression = buffer.number<std::int32_t>(root, 0);
  header.table_position = buffer.number<std::int64_t>(root, 1, -1);
  header.description = buffer.text(root, 2);
  if (!buffer.ok()) return std::nullopt;
  return header;
}

std::optional<std::vector<TableEntry>> decodeTable(std::string_view bytes) {
  auto [buffer, root, good] = open(bytes, "FTAB");
  if (!good) return std::nullopt;
  const FlatVector list = buffer.vector(root, 0, 4);
  std::vector<TableEntry> entries;
  for (std::size_t i = 0; i < list.count && buffer.ok(); ++i) {
    const FlatTable table = buffer.tableAt(list.position + 4 * i);
    TableEntry& entry = entries.emplace_back();
    entry.position = buffer.number<std::int64_t>(table, 0);
    const std::size_t header = buffer.field(table, 1, kPacketHeader_bytes);
    if (header != 0) {
      entry.stream = buffer.read<std::int32_t>(header);
      entry.size = buffer.read<std::int32_t>(header + 4);
    }
    entry.count = buffer.number<std::int64_t>(table, 2);
    entry.first_us = buffer.number<std::int64_t>(table, 3);
    entry.last_us = buffer.number<std::int64_t>(table, 4);
  }
  if (!buffer.ok()) return std::nullopt;
  return entries;
}

bool decodeEvents(std::string_view bytes, std::vector<Event>& events) {
  events.clear();
  auto [buffer, root, good] = open(bytes, "EVTS");
  if (!good) return false;
  const FlatVector list = buffer.vector(root, 0, kEvent_bytes);
  if (!buffer.ok()) return false;
  events.resize(list.count);
  const char* from = buffer.data() + list.position;
  bool times_good = true;
  for (Event& event : events) {
    std::int64_t time_us = 0;
    std::memcpy(&time_us, from, 8);
    std::memcpy(&event.x_px, from + 8, 2);
    std::memcpy(&event.y_px, from + 10, 2);
    event.brighter = from[12] != 0;
    times_good = times_good && isMicrosecond(time_us);
    event.time_ns = times_good ? time_us * kMicrosecond_ns : 0;
    from += kEvent_bytes;
  }
  if (!times_good) events.clear();
  return times_good;
}

bool decodeImu(std::string_view bytes, std::vector<RawImuSample>& samples) {
  samples.clear();
  auto [buffer, root, good] = open(bytes, "IMUS");
  if (!good) return false;
  const FlatVector list = buffer.vector(root, 0, 4);
  for (std::size_t i = 0; i < list.count && buffer.ok(); ++i) {
    const FlatTable table = buffer.tableAt(list.position + 4 * i);
    const auto time_us = buffer.number<std::int64_t>(table, 0);
    if (!isMicrosecond(time_us)) return false;
    RawImuSample sample;
    sample.time_ns = time_us * kMicrosecond_ns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      sample.specific_force[row] = static_cast<double>(buffer.number<float>(table, 2 + axis));
      sample.angular_rate[row] = static_cast<double>(buffer.number<float>(table, 5 + axis));
    }
    samples.push_back(sample);
  }
  if (!buffer.ok()) samples.clear();
  return buffer.ok();
}

std::optional<std::size_t> countTriggers(std::string_view bytes) {
  auto [buffer, root, good] = open(bytes, "TRIG");
  if (!good) return std::nullopt;
  const FlatVector list = buffer.vector(root, 0, 4);
  if (!buffer.ok()) return std::nullopt;
  return list.count;
}

std::string_view packetType(std::string_view bytes) {
  return FlatBuffer(bytes).identifier();
}

std::int64_t nearestMicrosecond(std::int64_t time_ns) {
  const std::int64_t floor_us = time_ns / kMicrosecond_ns - (time_ns % kMicrosecond_ns < 0 ? 1 : 0);
  return floor_us + (time_ns - floor_us * kMicrosecond_ns >= kMicrosecond_ns / 2 ? 1 : 0);
}

}  // namespace evical::aedat
