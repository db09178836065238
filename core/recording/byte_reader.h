// A cursor over bytes from a file that nobody vouches for: every step is checked against the end.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace evical {

// The formats we read and write are little-endian, and so is every machine we build for.
static_assert(std::endian::native == std::endian::little);

using Bytes = std::span<const std::uint8_t>;

// The caller knows that sizeof(T) bytes are there.
template <class T>
T loadLittleEndian(const std::uint8_t* bytes) {
  static_assert(std::is_arithmetic_v<T>);
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <class T>
void appendLittleEndian(std::vector<std::uint8_t>& bytes, T value) {
  static_assert(std::is_arithmetic_v<T>);
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof(T));
}

inline std::string_view textOf(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline Bytes bytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class ByteReader {
 public:
  explicit ByteReader(Bytes bytes) : bytes_(bytes) {}

  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }

  // False, and nothing moves, where that much is not left.
  template <class T>
  bool read(T& value) {
    if (remaining() < sizeof(T)) return false;
    value = loadLittleEndian<T>(bytes_.data() + position_);
    position_ += sizeof(T);
    return true;
  }

  bool take(std::size_t count, Bytes& taken) {
    if (remaining() < count) return false;
    taken = bytes_.subspan(position_, count);
    position_ += count;
    return true;
  }

  // u32 length, then content: strings and arrays of bytes in ROS 1, header and data of bag records.
  bool takeSized(Bytes& taken) {
    const std::size_t start = position_;
    std::uint32_t count = 0;
    if (read(count) && take(count, taken)) return true;
    position_ = start;
    return false;
  }

 private:
  Bytes bytes_;
  std::size_t position_ = 0;
};

}  // namespace evical
