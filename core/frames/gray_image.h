// A decoded frame for the finders: brightness, one byte per pixel.
#pragma once

#include "core/data/frame.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

struct GrayImage {
  Resolution size_px;
  std::vector<std::uint8_t> pixels;  // row by row, without gaps
};

// Brightness of a frame in the sensor's own pixels; the display orientation of an encoded picture is ignored.
// Pictures of 16 bits are scaled so that their 99.5th percentile is white: with a camera's 10 or 12 bits in
// such a container, the high byte alone would be nearly black. Throws CalibrationError (BadInput) with
// `place` if a picture is truncated, damaged, too large, or differs from the frame's specified size.
GrayImage decodeFrame(const Frame& frame, const std::string& place);

// Replaces the frame's content by its brightness, so that decodeFrame only copies it. A frame that cannot be
// decoded stays unchanged.
void decodeAhead(Frame& frame);

// Encoding of a frame as a picture file.

// For Gray8 frames. Fast, with moderate compression.
std::string encodedPng(const Frame& frame);

// Lossy; quality 1 to 100.
std::string encodedJpeg(const Frame& frame, int quality);

}  // namespace evical
