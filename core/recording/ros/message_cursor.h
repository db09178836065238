// Deserialisation of the fields of a ROS message, as ROS 1 or CDR (ROS 2), from untrusted
// bytes: no read goes past the end; a failed one makes ok() false permanently and yields zeros.
#pragma once

#include "core/base/time.h"
#include "core/recording/byte_cursor.h"
#include "core/recording/recording_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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

// Serialisation of the fields of a ROS message, as ROS 1 or CDR: the counterpart of MessageCursor.

namespace evical::ros {

// Bytes with their length in front, as in records of both kinds of bags.
inline std::string sized(std::string_view bytes) {
  return numberBytes(static_cast<std::uint32_t>(bytes.size())).append(bytes);
}

// Appends to `bytes`. Times must be within the range of a ROS time.
class MessageBytes {
 public:
  MessageBytes(std::string& bytes, Serialization serialization)
      : bytes_(bytes), cdr_(serialization == Serialization::Cdr), begin_(bytes.size()) {
    if (cdr_) bytes_.append("\0\1\0\0", 4);
    if (cdr_) begin_ += 4;
  }

  template <class Number>
  void append(Number value) {
    if (cdr_) bytes_.append((sizeof value - (bytes_.size() - begin_) % sizeof value) % sizeof value, '\0');
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  void appendTime(std::int64_t time_ns) {
    append(static_cast<std::uint32_t>(time_ns / kSecond_ns));
    append(static_cast<std::uint32_t>(time_ns % kSecond_ns));
  }

  void appendText(std::string_view characters) {
    append(static_cast<std::uint32_t>(characters.size() + (cdr_ ? 1 : 0)));
    bytes_ += characters;
    if (cdr_) bytes_.push_back('\0');
  }

  void appendSequence(std::span<const std::uint8_t> bytes) {
    append(static_cast<std::uint32_t>(bytes.size()));
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }

  // Without frame_id.
  void appendHeader(std::uint32_t sequence, std::int64_t stamp_ns) {
    if (!cdr_) append(sequence);
    appendTime(stamp_ns);
    appendText({});
  }

 private:
  std::string& bytes_;
  bool cdr_;
  std::size_t begin_;  // origin of the alignment
};

}  // namespace evical::ros
