// Compressions of HDF5 files that libhdf5 does not include: Blosc, LZF and Metavision's ECF (reading only).
#pragma once

#include "core/recording/hdf5/hdf5_library.h"

#include <cstddef>
#include <string>

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
