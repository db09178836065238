// Compression of a ROS 1 bag's chunks: standard LZ4 frames and bzip2 streams.
#pragma once

#include "core/recording/byte_reader.h"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace evical {

enum class Compression { None, Lz4, Bz2 };

// As the bag names it; nothing for others.
std::optional<Compression> compressionNamed(std::string_view name);
const char* compressionName(Compression compression);

enum class Unpacked {
  Whole,
  Partial,  // the packed bytes ended early; what came out so far is good
  Corrupt,  // they contradict themselves: nothing that came out can be trusted
};

// Appends to nothing: `unpacked` is replaced, its storage reused. It grows only as bytes really come out, and
// never beyond `limit`, since the size that a file claims is not to be believed.
Unpacked unpack(Compression compression, Bytes packed, std::size_t limit,
                std::vector<std::uint8_t>& unpacked);

// Fast settings. Bz2 isn't written: it costs much time for events, and every reader knows lz4.
void packLz4(Bytes plain, std::vector<std::uint8_t>& packed);

}  // namespace evical
