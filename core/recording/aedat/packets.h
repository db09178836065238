// Packets of an AEDAT4 file, its header and table: unpacked bytes to numbers and back. Times in the file are
// us. Source: inivation-docs "AEDAT_file_formats.md", dv-processing (fbs files).
#pragma once

#include "core/base/time.h"
#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/data/imu_units.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical::aedat {

inline constexpr std::string_view kMagic = "#!AER-DAT4.0\r\n";
inline constexpr std::size_t kPacketHeader_bytes = 8;  // i32 stream, i32 size

struct FileHeader {
  std::int32_t compression = 0;
  std::int64_t table_position = -1;
  std::string description;  // XML
};

struct TableEntry {
  std::int64_t position = 0;  // of the packet's header
  std::int32_t stream = 0;
  std::int32_t size = 0;
  std::int64_t count = 0;
  std::int64_t first_us = 0, last_us = 0;
};

// All with the size prefix. The decoders return false or empty values if the bytes are damaged.
std::optional<FileHeader> decodeHeader(std::string_view bytes);
std::optional<std::vector<TableEntry>> decodeTable(std::string_view bytes);
bool decodeEvents(std::string_view bytes, std::vector<Event>& events);
bool decodeImu(std::string_view bytes, std::vector<RawImuSample>& samples);  // in g and deg/s
// The frame's time is the middle of the exposure. `unusable` completes a sentence with the reason why an
// intact frame cannot be used; it is empty otherwise.
bool decodeFrame(std::string_view bytes, Frame& frame, std::string& unusable);
std::optional<std::size_t> countTriggers(std::string_view bytes);
std::string_view packetType(std::string_view bytes);  // "EVTS", ...; empty if there is none

// `position_at` is the position of the table's position, to be overwritten once that is known.
std::string encodeHeader(const FileHeader& header, std::size_t& position_at);
std::string encodeTable(std::span<const TableEntry> entries);
std::string encodeEvents(EventSpan events);
std::string encodeImu(std::span<const RawImuSample> samples);  // given in g and deg/s

}  // namespace evical::aedat

// Google's FlatBuffers, parsed without a library from untrusted bytes: size prefix, offset of the root table,
// four letters that name the type, tables. Nothing is read past the end; any failure makes ok() false
// permanently and yields zeros. Fields that equal their default are absent. Source: flatbuffers.dev,
// "Internals".

namespace evical::aedat {

struct FlatTable {
  std::size_t position = 0;  // in the buffer
  std::size_t vtable = 0;
  std::size_t fields = 0;
};

struct FlatVector {
  std::size_t position = 0;  // of the first element
  std::size_t count = 0;
};

class FlatBuffer {
 public:
  explicit FlatBuffer(std::string_view bytes);  // with the size prefix

  bool ok() const { return ok_; }
  std::string_view identifier() const { return identifier_; }
  const char* data() const { return bytes_.data(); }  // origin of positions

  FlatTable root() { return tableAt(0); }
  FlatTable tableAt(std::size_t position);  // position of the offset to the table

  // Position of a field of `size` bytes; 0 if it is absent.
  std::size_t field(const FlatTable& table, std::size_t index, std::size_t size);

  template <class Number>
  Number number(const FlatTable& table, std::size_t index, Number absent = {}) {
    const std::size_t position = field(table, index, sizeof(Number));
    return position == 0 ? absent : read<Number>(position);
  }
  FlatVector vector(const FlatTable& table, std::size_t index, std::size_t element_bytes);
  std::string_view text(const FlatTable& table, std::size_t index);

  template <class Number>
  Number read(std::size_t position) {
    Number value{};
    if (position > bytes_.size() || bytes_.size() - position < sizeof(Number)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data() + position, sizeof(Number));
    return value;
  }

 private:
  std::string_view bytes_;  // after the size prefix
  std::string_view identifier_;
  bool ok_ = false;
};

}  // namespace evical::aedat
