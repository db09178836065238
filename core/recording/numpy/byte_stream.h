// Bytes of a file, of a part of one, or of deflated data in it, in order and without storing them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace evical::numpy {

// Position of an array's bytes: alone in a file, or as a member of an archive.
struct ByteRange {
  std::filesystem::path path;
  std::uint64_t position = 0;
  std::uint64_t packed_bytes = 0;  // in the file
  std::uint64_t bytes = 0;         // unpacked: an upper limit, for any claim of the file
  bool deflated = false;
  std::optional<std::uint32_t> checksum;  // CRC-32 of the unpacked bytes
};

class ByteStream {
 public:
  virtual ~ByteStream() = default;

  // Next bytes, up to `count`; 0 at the end, or if the rest is damaged.
  virtual std::size_t read(char* bytes, std::size_t count) = 0;

  // False if fewer remain.
  virtual bool skip(std::uint64_t count) = 0;

  // Problem of the bytes read so far; empty if none. A checksum is compared after the last byte.
  virtual std::string problem() const = 0;
};

// Throws CalibrationError (BadInput) if the file cannot be opened.
std::unique_ptr<ByteStream> openBytes(const ByteRange& range);

// Largest unpacked size of deflated bytes.
std::uint64_t mostInflated(std::uint64_t packed_bytes);

}  // namespace evical::numpy
