// Headers of image files, sufficient for code that does not decode them.
#pragma once

#include <cstdint>
#include <string>

namespace evical::test {

inline std::string bigEndianBytes(std::uint32_t value, int count) {
  std::string bytes;
  for (int i = count; i-- > 0;) bytes.push_back(static_cast<char>(value >> (8 * i)));
  return bytes;
}

inline std::string pngBytes(std::uint32_t width, std::uint32_t height) {
  return std::string("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16) + bigEndianBytes(width, 4) +
         bigEndianBytes(height, 4) + std::string("\x08\0\0\0\0", 5) + "and so on";
}

// With an application segment before the frame.
inline std::string jpegBytes(std::uint32_t width, std::uint32_t height) {
  return std::string("\xFF\xD8\xFF\xE0\0\x06JFIF\xFF\xC0\0\x11\x08", 15) + bigEndianBytes(height, 2) +
         bigEndianBytes(width, 2) + "and so on";
}

}  // namespace evical::test
