// AEDAT 2.0 files, built without the product's code.
#pragma once

#include "core/data/event.h"
#include "tests/core/recording/picture_samples.h"

#include <array>
#include <cstdint>
#include <string>

namespace evical::test {

inline std::string aedat2Header(const std::string& chip) {
  std::string header = "#!AER-DAT2.0\r\n# This is a raw AE data file - do not edit\r\n";
  if (!chip.empty()) header += "# AEChip: eu.seebetter.ini.chips.davis." + chip + "\r\n";
  return header;
}

inline std::string aedat2Record(std::uint32_t address, std::int32_t time_us) {
  return bigEndianBytes(address, 4) + bigEndianBytes(static_cast<std::uint32_t>(time_us), 4);
}

inline std::uint32_t davisAddress(const Event& event, int width, int height) {
  return static_cast<std::uint32_t>(height - 1 - event.y_px) << 22 |
         static_cast<std::uint32_t>(width - 1 - event.x_px) << 12 | (event.brighter ? 0x800U : 0U);
}

inline std::uint32_t dvs128Address(const Event& event) {
  return static_cast<std::uint32_t>(127 - event.y_px) << 8 |
         static_cast<std::uint32_t>(127 - event.x_px) << 1 | (event.brighter ? 0U : 1U);
}

// One reading of a pixel's voltage, of 10 bits: after its reset, or after its exposure.
inline std::uint32_t apsAddress(int x_px, int y_px, bool after_exposure, int value, int height) {
  return 0x8000'0000U | static_cast<std::uint32_t>(height - 1 - y_px) << 22 |
         static_cast<std::uint32_t>(x_px) << 12 | (after_exposure ? 0x400U : 0U) |
         static_cast<std::uint32_t>(value);
}

// Acceleration, temperature, angular rate, as seven words.
inline std::string aedat2Imu(const std::array<std::int16_t, 7>& values, std::int32_t time_us) {
  std::string bytes;
  for (std::uint32_t code = 0; code < values.size(); ++code) {
    const auto value = static_cast<std::uint16_t>(values[code]);
    bytes += aedat2Record(0x8000'0C00U | code << 28 | std::uint32_t{value} << 12, time_us);
  }
  return bytes;
}

}  // namespace evical::test
