// Deserialisation of the fields of a ROS message, as ROS 1 or CDR (ROS 2), from untrusted
// bytes: no read goes past the end; a failed one makes ok() false permanently and yields zeros.
#pragma once

#include "core/recording/byte_cursor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace evical::ros {

enum class Serialization {
  Ros1,  // little endian, no padding
  Cdr,   // four bytes for the byte order, then each number at a multiple of its size, counted from there
};

class MessageCursor {
 public:
  MessageCursor(std::string_view message, Serialization serialization)
      : bytes_(message), cdr_(serialization == Serialization::Cdr) {
    if (!cdr_) return;
    const std::string_view encapsulation = bytes_.take(4);
    const bool known = bytes_.ok() && encapsulation[0] == 0 && (encapsulation[1] & ~1) == 0;
    if (!known) bytes_.take(~std::uint64_t{0});  // fails
    big_endian_ = known && encapsulation[1] == 0;
  }

  bool ok() const { return bytes_.ok(); }
  bool isRos1() const { return !cdr_; }
  bool bigEndian() const { return big_endian_; }
  std::size_t remaining() const { return bytes_.remaining(); }
  // CDR may end with padding.
  bool wellEnded() const { return ok() && (cdr_ || bytes_.atEnd()); }

  template <class Number>
  Number number() {
    align(sizeof(Number));
    const Number value = bytes_.number<Number>();
    if (!big_endian_) return value;
    auto reversed = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    std::reverse(reversed.begin(), reversed.end());
    return std::bit_cast<Number>(reversed);
  }

  std::string_view take(std::uint64_t count) { return bytes_.take(count); }
  std::string_view sequence() { return bytes_.take(number<std::uint32_t>()); }  // of bytes
  std::string_view text() {
    std::string_view characters = sequence();
    if (cdr_ && characters.ends_with('\0')) characters.remove_suffix(1);
    return characters;
  }

  std::int64_t time_ns() {
    const std::int64_t seconds = cdr_ ? number<std::int32_t>() : std::int64_t{number<std::uint32_t>()};
    return seconds * 1'000'000'000 + number<std::uint32_t>();
  }

  // The stamp of a std_msgs/Header.
  std::int64_t header() {
    if (!cdr_) number<std::uint32_t>();  // seq
    const std::int64_t stamp_ns = time_ns();
    text();  // frame_id
    return stamp_ns;
  }

 private:
  void align(std::size_t size) {
    constexpr std::size_t kEncapsulation_bytes = 4;
    if (!cdr_ || !bytes_.ok()) return;
    const std::size_t beyond = (bytes_.position() - kEncapsulation_bytes) % size;
    if (beyond != 0) bytes_.take(size - beyond);
  }

  ByteCursor bytes_;
  bool cdr_, big_endian_ = false;
};

}  // namespace evical::ros
