// Limit of what a packed file may unpack to: a small one could take all memory, or an hour.
#pragma once

#include "core/base/error.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace evical {

// Events unpack to 2 to 20 times their size, text to 50 times, and pictures without any noise to 1000 times.
class UnpackingLimit {
 public:
  UnpackingLimit(std::string file, std::uint64_t file_bytes)
      : UnpackingLimit(std::move(file), file_bytes, std::uint64_t{1} << 30, 300) {}
  // Text takes longer than packets.
  static UnpackingLimit ofText(std::string file, std::uint64_t file_bytes) {
    return {std::move(file), file_bytes, std::uint64_t{1} << 28, 100};
  }

  // Limit of one part in memory: a chunk, a packet or a message.
  static std::uint64_t ofPart(std::uint64_t packed_bytes) {
    constexpr std::uint64_t kAlways_bytes = std::uint64_t{1} << 27, kTimes = 100;
    return std::max(kAlways_bytes, kTimes * packed_bytes);
  }

  // Counts what was unpacked since the beginning. Throws CalibrationError (BadInput) if it is too much for
  // the whole file.
  void add(std::uint64_t bytes) {
    unpacked_bytes_ += bytes;
    if (unpacked_bytes_ <= max_bytes_) return;
    throw badInput(file_,
                   "unpacks to more than " + std::to_string(unpacked_bytes_ >> 20) +
                       " MB, although it has only " + std::to_string((file_bytes_ >> 10) + 1) +
                       " kB: it is not a recording",
                   "If it is one, unpack it with the program that recorded it");
  }
  void restart() { unpacked_bytes_ = 0; }
  // For files that are still being written.
  void setFileBytes(std::uint64_t bytes) {
    file_bytes_ = bytes;
    max_bytes_ = std::max(max_bytes_, times_ * bytes);
  }

 private:
  UnpackingLimit(std::string file, std::uint64_t file_bytes, std::uint64_t always_bytes, std::uint64_t times)
      : file_(std::move(file)),
        file_bytes_(file_bytes),
        times_(times),
        max_bytes_(std::max(always_bytes, times * file_bytes)) {}

  std::string file_;
  std::uint64_t file_bytes_, times_, max_bytes_, unpacked_bytes_ = 0;
};

}  // namespace evical
