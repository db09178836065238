// Text header of Prophesee's RAW and DAT files, as written by all versions of the SDK.
#pragma once

#include "core/geometry/resolution.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace evical::prophesee {

enum class Encoding { Evt2, Evt21, Evt3, Dat };
enum class HalfOrder { Unknown, Plain, Exchanged };  // of the two halves of EVT 2.1's words

struct FileHeader {
  Encoding encoding = Encoding::Evt2;
  HalfOrder half_order = HalfOrder::Unknown;
  Resolution resolution_px;       // if the file or its system states it
  std::uint64_t data_offset = 0;  // in the file
  int version = 0;                // of DAT
  unsigned char event_type = 0;   // of DAT: 0 and 12 events, 14 triggers
};

inline constexpr std::size_t kLargestHeader_bytes = 65536;

// `start`: the file's first bytes, all of them or kLargestHeader_bytes. Throws CalibrationError
// (BadInput) with the byte if a header is cut, or an encoding is unknown.
FileHeader parseHeader(const std::filesystem::path& path, std::string_view start);

// A DAT file without any text: its two bytes, then events whose times do not decrease.
bool isBareDat(std::string_view start);

}  // namespace evical::prophesee
