// The flatbuffers have fixed offsets: the bytes before an element are the same in every packet.
#include "core/base/time.h"
#include "core/recording/aedat/packets.h"

#include <array>
#include <cstring>
#include <initializer_list>

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
