// Compressions of HDF5 files that libhdf5 does not include: Blosc, LZF and Metavision's ECF (reading only).
#pragma once

#include "core/recording/hdf5/hdf5_library.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace evical::hdf5 {

inline constexpr H5Z_filter_t kLzf = 32000, kBlosc = 32001, kEcf = 0x8ECF;

// Registers them in this process; repeated calls are harmless.
void registerFilters();

// Expected unpacked size of a chunk during this thread's reads: libhdf5 copies this much out of a
// filter's result, without checking its size.
class ExpectedChunk {
 public:
  explicit ExpectedChunk(std::size_t bytes);
  ~ExpectedChunk();
  ExpectedChunk(const ExpectedChunk&) = delete;
  ExpectedChunk& operator=(const ExpectedChunk&) = delete;
};

// Chunks of `rows` elements of `element_bytes`, by Blosc with zstd and byte shuffle.
void setBlosc(hid_t creation, std::size_t element_bytes, std::size_t chunk_bytes);

// Usual name of a filter: "32015 (Zstandard)".
std::string filterName(H5Z_filter_t filter);

}  // namespace evical::hdf5

// Metavision's event compression for HDF5, filter 0x8ECF: one chunk of events.
// Source: docs.prophesee.ai (hdf5), prophesee-ai/hdf5_ecf.

namespace evical::hdf5 {

// Layout of the file's compound type.
struct EcfEvent {
  std::uint16_t x = 0, y = 0;
  std::int16_t p = 0;
  std::int16_t padding = 0;
  std::int64_t t = 0;  // us
};
static_assert(sizeof(EcfEvent) == 16);

inline constexpr std::int64_t kNoTime_us = std::numeric_limits<std::int64_t>::min();  // no event has it

// False if the bytes are damaged.
bool decodeEcf(std::string_view bytes, std::vector<EcfEvent>& events);

}  // namespace evical::hdf5
