// Compression of chunks and messages of ROS recordings. A wrong size does not make memory grow: memory is
// proportional to the actual data.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace evical::ros {

enum class Unpacked {
  Whole,
  Cut,      // the data ended early; the output so far is good
  Damaged,  // the data are invalid; no output
};

// All replace `output` by the content of `size_bytes`.
Unpacked unpackLz4(std::string_view data, std::uint64_t size_bytes, std::string& output);  // LZ4 frames
Unpacked unpackBz2(std::string_view data, std::uint64_t size_bytes, std::string& output);
Unpacked unpackZstd(std::string_view data, std::uint64_t size_bytes, std::string& output);
Unpacked copyPlain(std::string_view data, std::uint64_t size_bytes, std::string& output);

// Unpacks one zstd frame of any plausible size. If it is damaged, `output` has what took its place so far.
Unpacked unpackZstdFrame(std::string_view data, std::string& output);
inline constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";

// Replace `output` by one frame.
void packLz4(std::string_view data, std::string& output);
void packZstd(std::string_view data, std::string& output);

}  // namespace evical::ros
