#include "core/recording/aedat/packets.h"

#include "core/base/time.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <limits>

// The flatbuffers have fixed offsets: the bytes before an element are the same in every packet.

namespace evical::aedat {
namespace {

template <class Number>
void append(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(Number));
}

template <class Number>
void put(std::string& bytes, std::size_t position, Number value) {
  std::memcpy(bytes.data() + position, &value, sizeof(Number));
}

void pad(std::string& bytes, std::size_t alignment, std::size_t rest = 0) {
  while (bytes.size() % alignment != rest) bytes.push_back('\0');
}

void appendVtable(std::string& bytes, std::uint16_t table_bytes,
                  std::initializer_list<std::uint16_t> fields) {
  append(bytes, static_cast<std::uint16_t>(4 + 2 * fields.size()));
  append(bytes, table_bytes);
  for (const std::uint16_t field : fields) append(bytes, field);
}

void appendVtableOffset(std::string& bytes, std::size_t vtable) {
  append(bytes, static_cast<std::int32_t>(bytes.size() - vtable));
}

void finishSize(std::string& bytes) {
  put(bytes, 0, static_cast<std::uint32_t>(bytes.size() - 4));
}

// Size prefix, root offset, type, and a root table whose only field is a vector; its
// count is the last number.
std::string startVector(std::string_view type, std::size_t count) {
  std::string bytes;
  append(bytes, std::uint32_t{0});
  append(bytes, std::uint32_t{16});  // from here to the root table at 20
  bytes += type;
  appendVtable(bytes, 8, {4});
  pad(bytes, 4);
  appendVtableOffset(bytes, 12);
  append(bytes, std::uint32_t{4});
  append(bytes, static_cast<std::uint32_t>(count));
  return bytes;
}

// A vector of equal tables: their offsets, one vtable for all, then the tables, each beginning 4 bytes past a
// multiple of 8 so that its i64 fields, which come first, are aligned.
template <class Append>
std::string tables(std::string_view type, std::size_t count, std::uint16_t table_bytes,
                   std::initializer_list<std::uint16_t> fields, Append&& appendFields) {
  std::string bytes = startVector(type, count);
  const std::size_t offsets = bytes.size();
  bytes.resize(offsets + 4 * count);
  pad(bytes, 4);
  const std::size_t vtable = bytes.size();
  appendVtable(bytes, table_bytes, fields);
  for (std::size_t i = 0; i < count; ++i) {
    pad(bytes, 8, 4);
    put(bytes, offsets + 4 * i, static_cast<std::uint32_t>(bytes.size() - (offsets + 4 * i)));
    appendVtableOffset(bytes, vtable);
    appendFields(bytes, i);
  }
  finishSize(bytes);
  return bytes;
}

}  // namespace

std::string encodeHeader(const FileHeader& header, std::size_t& position_at) {
  std::string bytes;
  append(bytes, std::uint32_t{0});
  append(bytes, std::uint32_t{24});  // from here to the root table at 28
  bytes += "IOHE";
  appendVtable(bytes, 20, {16, 4, 12});
  pad(bytes, 8, 4);
  appendVtableOffset(bytes, 12);
  position_at = bytes.size();
  append(bytes, header.table_position);
  append(bytes, std::uint32_t{8});  // from here to the string at 48
  append(bytes, header.compression);
  append(bytes, static_cast<std::uint32_t>(header.description.size()));
  bytes += header.description;
  bytes.push_back('\0');
  pad(bytes, 8);
  finishSize(bytes);
  return bytes;
}

std::string encodeTable(std::span<const TableEntry> entries) {
  const auto fields = [&](std::string& bytes, std::size_t i) {
    const TableEntry& entry = entries[i];
    append(bytes, entry.position);
    append(bytes, entry.stream);
    append(bytes, entry.size);
    append(bytes, entry.count);
    append(bytes, entry.first_us);
    append(bytes, entry.last_us);
  };
  return tables("FTAB", entries.size(), 44, {4, 12, 20, 28, 36}, fields);
}

std::string encodeEvents(EventSpan events) {
  std::string bytes = startVector("EVTS", events.size());
  bytes.reserve(bytes.size() + 16 * events.size());
  for (const Event& event : events) {
    append(bytes, nearestMicrosecond(event.time_ns));
    append(bytes, event.x_px);
    append(bytes, event.y_px);
    append(bytes, std::uint32_t{event.brighter ? 1U : 0U});
  }
  finishSize(bytes);
  return bytes;
}

std::string encodeImu(std::span<const RawImuSample> samples) {
  const auto fields = [&](std::string& bytes, std::size_t i) {
    const RawImuSample& sample = samples[i];
    append(bytes, nearestMicrosecond(sample.time_ns));
    for (const double value : sample.specific_force) append(bytes, static_cast<float>(value));
    for (const double value : sample.angular_rate) append(bytes, static_cast<float>(value));
  };
  // Temperature and magnetic field are unknown.
  return tables("IMUS", samples.size(), 36, {4, 0, 12, 16, 20, 24, 28, 32}, fields);
}

}  // namespace evical::aedat

namespace evical::aedat {
namespace {

constexpr std::size_t kEvent_bytes = 16;  // i64 t, i16 x, i16 y, u8 on, 3 bytes of padding
constexpr std::int64_t kLatest_us = kLatestTime_ns / kMicrosecond_ns;

constexpr std::int64_t kLongestExposure_us = 3'600'000'000;

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

// OpenCV's numbers for its types of 1, 3 and 4 channels of 8 bit.
struct PixelFormat {
  int number;
  FrameFormat format;
  std::size_t pixel_bytes;
};
constexpr PixelFormat kPixelFormats[] = {
    {0, FrameFormat::Gray8, 1}, {16, FrameFormat::Bgr8, 3}, {24, FrameFormat::Bgra8, 4}};

// An unknown begin or end of the exposure is 0 or absent; newer files then state its length, and the frame's
// time is its begin.
bool takeFrameTime(FlatBuffer& buffer, const FlatTable& root, Frame& frame) {
  const auto time_us = buffer.number<std::int64_t>(root, 0);
  const auto begin_us = buffer.number<std::int64_t>(root, 3), end_us = buffer.number<std::int64_t>(root, 4);
  const auto length_us = buffer.number<std::int64_t>(root, 11);
  if (!buffer.ok() || !isMicrosecond(time_us) || !isMicrosecond(begin_us) || !isMicrosecond(end_us))
    return false;
  frame.time_ns = time_us * kMicrosecond_ns;
  std::int64_t exposure_us = 0;
  if (begin_us != 0 && end_us >= begin_us) {
    exposure_us = end_us - begin_us;
    frame.time_ns = begin_us * kMicrosecond_ns + exposure_us * (kMicrosecond_ns / 2);
  } else if (length_us > 0 && isMicrosecond(time_us + std::min(length_us, kLongestExposure_us))) {
    exposure_us = std::min(length_us, kLongestExposure_us);
    frame.time_ns += exposure_us * (kMicrosecond_ns / 2);
  }
  frame.exposure_s = 1e-6 * static_cast<double>(exposure_us);
  return true;
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

bool decodeFrame(std::string_view bytes, Frame& frame, std::string& unusable) {
  frame = {};
  unusable.clear();
  auto [buffer, root, good] = open(bytes, "FRME");
  if (!good || !takeFrameTime(buffer, root, frame)) return false;
  const int format = buffer.number<std::int8_t>(root, 5);
  const int width = buffer.number<std::int16_t>(root, 6), height = buffer.number<std::int16_t>(root, 7);
  const int left = buffer.number<std::int16_t>(root, 8), top = buffer.number<std::int16_t>(root, 9);
  const FlatVector pixels = buffer.vector(root, 10, 1);
  if (!buffer.ok() || width <= 0 || height <= 0) return false;
  const PixelFormat* const known = std::find_if(std::begin(kPixelFormats), std::end(kPixelFormats),
                                                [&](const PixelFormat& f) { return f.number == format; });
  if (known == std::end(kPixelFormats)) {
    unusable = fmt::format("are in the format {}; only 8 bit grey, BGR and BGRA can be read", format);
    return true;
  }
  if (left != 0 || top != 0) {
    unusable = fmt::format("show only a part of the sensor, from column {} and row {}", left, top);
    return true;
  }
  frame.format = known->format;
  frame.size_px = {width, height};
  frame.row_bytes = known->pixel_bytes * static_cast<std::size_t>(width);
  const std::size_t size = frame.row_bytes * static_cast<std::size_t>(height);
  if (size > pixels.count) return false;
  const char* const from = buffer.data() + pixels.position;
  frame.bytes.assign(from, from + size);
  return true;
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

}  // namespace evical::aedat

namespace evical::aedat {
namespace {

constexpr std::size_t kVtableHeader_bytes = 4;

}  // namespace

FlatBuffer::FlatBuffer(std::string_view bytes) {
  ByteCursor cursor(bytes);
  bytes_ = cursor.sized();
  ok_ = cursor.ok() && bytes_.size() >= 8;
  if (ok_) identifier_ = bytes_.substr(4, 4);
}

FlatTable FlatBuffer::tableAt(std::size_t position) {
  FlatTable table;
  const std::size_t offset = read<std::uint32_t>(position);
  table.position = position + offset;
  const std::int64_t vtable = static_cast<std::int64_t>(table.position) - read<std::int32_t>(table.position);
  if (vtable < 0) ok_ = false;
  if (!ok_) return {};
  table.vtable = static_cast<std::size_t>(vtable);
  const std::size_t size = read<std::uint16_t>(table.vtable);
  if (!ok_ || size < kVtableHeader_bytes || size > bytes_.size() - table.vtable) {
    ok_ = false;
    return {};
  }
  table.fields = (size - kVtableHeader_bytes) / 2;
  return table;
}

std::size_t FlatBuffer::field(const FlatTable& table, std::size_t index, std::size_t size) {
  if (!ok_ || index >= table.fields) return 0;
  const std::size_t offset = read<std::uint16_t>(table.vtable + kVtableHeader_bytes + 2 * index);
  if (offset == 0) return 0;
  const std::size_t position = table.position + offset;
  if (position <= bytes_.size() && size <= bytes_.size() - position) return position;
  ok_ = false;
  return 0;
}

FlatVector FlatBuffer::vector(const FlatTable& table, std::size_t index, std::size_t element_bytes) {
  const std::size_t at = field(table, index, 4);
  if (at == 0) return {};
  const std::size_t start = at + read<std::uint32_t>(at);
  const FlatVector vector{start + 4, read<std::uint32_t>(start)};
  if (ok_ && vector.count <= (bytes_.size() - vector.position) / element_bytes) return vector;
  ok_ = false;
  return {};
}

std::string_view FlatBuffer::text(const FlatTable& table, std::size_t index) {
  const FlatVector letters = vector(table, index, 1);
  return bytes_.substr(letters.position, letters.count);
}

}  // namespace evical::aedat
