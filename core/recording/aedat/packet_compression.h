// Compression of an AEDAT4 file's packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace evical::aedat {

enum class Compression : std::int32_t { None, Lz4, Lz4High, Zstd, ZstdHigh };  // as in the file
inline constexpr std::int32_t kCompressions = 5;

std::string_view compressionName(Compression compression);  // as DV writes it into the XML
std::string_view frameMagic(Compression compression);       // first bytes of packed data

class Unpacker {
 public:
  explicit Unpacker(Compression compression);
  ~Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  // Content of the frame at the front of `packed`, valid until the next call, and the frame's length;
  // false if it is damaged, cut off or unreasonably large. Memory grows with the unpacked data, not
  // with the size that a frame claims.
  bool unpack(std::string_view packed, std::string_view& content, std::size_t& frame_bytes);
  std::size_t unpackedBytes() const { return produced_; }  // of the last call, also of a damaged packet

 private:
  struct Contexts;
  bool step(const char*& in, std::size_t& in_bytes, char* out, std::size_t& out_bytes, bool& finished);
  bool grow(std::size_t packed_bytes);

  Compression compression_;
  std::unique_ptr<Contexts> contexts_;
  std::string buffer_;
  std::size_t produced_ = 0;
};

// Throws std::bad_alloc if there is no memory.
void pack(Compression compression, std::string_view content, std::string& packed);

}  // namespace evical::aedat
