// Metavision's event compression for HDF5, filter 0x8ECF: one chunk of events.
// Source: docs.prophesee.ai (hdf5), prophesee-ai/hdf5_ecf.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

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
