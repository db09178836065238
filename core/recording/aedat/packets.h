// Packets of an AEDAT4 file, its header and table: unpacked bytes to numbers and back. Times in the file are
// us. Source: inivation-docs "AEDAT_file_formats.md", dv-processing (fbs files).
#pragma once

#include "core/base/time.h"
#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/data/imu_units.h"

#include <cstdint>
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
