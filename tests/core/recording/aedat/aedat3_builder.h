// AEDAT 3.1 files, built without the product's code.
#pragma once

#include "core/data/event.h"
#include "tests/core/recording/bag_builder.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace evical::test {

inline std::string aedat3Header(const std::string& source = "DAVIS240C") {
  return "#!AER-DAT3.1\r\n#Format: RAW\r\n#Source 1: " + source +
         "\r\n#Start-Time: 2026-01-01 00:00:00 (TZ+0000)\r\n#!END-HEADER\r\n";
}

inline std::string aedat3Packet(std::int16_t type, std::int32_t size, const std::string& events,
                                std::int32_t overflow = 0, std::int16_t source = 1) {
  const auto count = static_cast<std::int32_t>(events.size()) / size;
  return bytesOf(type) + bytesOf(source) + bytesOf(size) + bytesOf(std::int32_t{4}) + bytesOf(overflow) +
         bytesOf(count) + bytesOf(count) + bytesOf(count) + events;
}

// Times are in us since the overflow's time.
inline std::string aedat3Events(const std::vector<Event>& events, std::int32_t overflow = 0,
                                std::int16_t source = 1) {
  std::string bytes;
  for (const Event& event : events)
    bytes += bytesOf(1U | (event.brighter ? 2U : 0U) | std::uint32_t{event.y_px} << 2 |
                     std::uint32_t{event.x_px} << 17) +
             bytesOf(static_cast<std::int32_t>(event.time_ns / 1000));
  return aedat3Packet(1, 8, bytes, overflow, source);
}

inline std::string aedat3Imu(std::int32_t time_us, const std::array<float, 7>& values,
                             bool nine_axes = false) {
  std::string bytes = bytesOf(std::uint32_t{1}) + bytesOf(time_us);
  for (const float value : values) bytes += bytesOf(value);
  if (nine_axes) bytes += std::string(12, '\0');
  return aedat3Packet(nine_axes ? 4 : 3, nine_axes ? 48 : 36, bytes);
}

struct Aedat3Frame {
  std::uint32_t channels = 1;
  std::int32_t exposure_begin_us = 0, exposure_end_us = 0, width = 3, height = 2, left = 0, top = 0;
};

// Each value of a pixel is 256 times its index from 1, plus 7.
inline std::string aedat3FramePacket(const Aedat3Frame& frame) {
  std::string bytes = bytesOf(1U | frame.channels << 1) + bytesOf(std::int32_t{1}) +
                      bytesOf(std::int32_t{2}) + bytesOf(frame.exposure_begin_us) +
                      bytesOf(frame.exposure_end_us) + bytesOf(frame.width) + bytesOf(frame.height) +
                      bytesOf(frame.left) + bytesOf(frame.top);
  for (std::uint32_t i = 0; i < 6 * frame.channels; ++i)
    bytes += bytesOf(static_cast<std::uint16_t>(256 * (i + 1) + 7));
  return aedat3Packet(2, static_cast<std::int32_t>(bytes.size()), bytes);
}

}  // namespace evical::test
