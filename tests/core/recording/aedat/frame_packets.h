// AEDAT4's packets of frames, encoded by hand; fields of 0 are absent, as in flatbuffers.
#pragma once

#include "tests/core/recording/bag_builder.h"

#include <cstdint>
#include <string>

namespace evical::test {

struct TestFrame {
  std::int64_t time_us = 0, exposure_begin_us = 0, exposure_end_us = 0, exposure_us = 0;
  std::int8_t format = 0;
  std::int16_t width = 0, height = 0, left = 0, top = 0;
  std::string pixels;
};

inline std::string framePacket(const TestFrame& frame) {
  constexpr std::uint16_t kTable_bytes = 68;
  const auto at = [](std::int64_t value, std::uint16_t offset) {
    return bytesOf(static_cast<std::uint16_t>(value == 0 ? 0 : offset));
  };
  std::string vtable = bytesOf(std::uint16_t{4 + 2 * 12}) + bytesOf(kTable_bytes);
  vtable += at(frame.time_us, 8) + at(1, 16) + at(1, 24) + at(frame.exposure_begin_us, 32);
  vtable += at(frame.exposure_end_us, 40) + at(frame.format, 64) + at(frame.width, 56) + at(frame.height, 58);
  vtable += at(frame.left, 60) + at(frame.top, 62) + at(1, 4) + at(frame.exposure_us, 48);
  const std::size_t table = 8 + vtable.size();  // from the end of the size field
  std::string bytes = bytesOf(static_cast<std::uint32_t>(table)) + "FRME" + vtable;
  bytes += bytesOf(static_cast<std::int32_t>(vtable.size()));
  bytes += bytesOf(std::uint32_t{kTable_bytes - 4});  // to the pixels, after the table
  bytes += bytesOf(frame.time_us) + bytesOf(frame.time_us) + bytesOf(frame.time_us);
  bytes += bytesOf(frame.exposure_begin_us) + bytesOf(frame.exposure_end_us) + bytesOf(frame.exposure_us);
  bytes += bytesOf(frame.width) + bytesOf(frame.height) + bytesOf(frame.left) + bytesOf(frame.top);
  bytes += bytesOf(frame.format) + std::string(3, '\0');
  bytes += sized(frame.pixels);
  return sized(bytes);
}

}  // namespace evical::test
