// Serialisation of the fields of a ROS message, as ROS 1 or CDR: the counterpart of MessageCursor.
#pragma once

#include "core/base/time.h"
#include "core/recording/part_file.h"
#include "core/recording/ros/message_cursor.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

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
