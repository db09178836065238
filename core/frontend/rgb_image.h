// A picture, and its output as a PNG file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical {

struct RgbImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;  // row by row
};

// Throws CalibrationError (BadInput) if the file cannot be written.
void writePng(const std::filesystem::path& path, const RgbImage& image);

}  // namespace evical
